#include "verify/trace/program/trace_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "io/help/command_line.h"
#include "streaming/error.h"
#include "verify/trace/program/picture_name.h"
#include "verify/trace/program/presets.h"

namespace svdag {

namespace {

std::vector<double> numbers(const std::string& name, const std::string& text) {
  std::vector<double> values;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    double value = 0;
    const auto read = std::from_chars(at, end, value);
    if (read.ec != std::errc() || !std::isfinite(value) || (read.ptr != end && *read.ptr != ','))
      fail_usage(name + ": \"" + text + "\" is not a list of finite numbers separated by commas");
    values.push_back(value);
    if (read.ptr == end) return values;
    at = read.ptr + 1;
  }
}

double number(const std::string& name, const std::string& text, double max) {
  const std::vector<double> values = numbers(name, text);
  if (values.size() != 1 || !(values[0] >= 0 && values[0] <= max))
    fail_usage(name + ": \"" + text + "\" is not a number in the valid range");
  return values[0];
}

uint32_t side(const std::string& text) {
  uint32_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || value < 1 || value > 16384)
    fail_usage("--size: \"" + text + "\" is not a number from 1 to 16384");
  return value;
}

void set_size(const std::string& text, TraceOptions* options) {
  const size_t cross = text.find('x');
  if (cross == std::string::npos) fail_usage("--size: \"" + text + "\" is not WIDTHxHEIGHT");
  options->width = side(text.substr(0, cross));
  options->height = side(text.substr(cross + 1));
}

void add_view_options(CLI::App* app, TraceOptions* options) {
  app->add_option_function<std::string>(
         "--size", [=](const std::string& s) { set_size(s, options); }, "Pixels (default 1280x720)")
      ->type_name("WxH");
  one_of(app->add_option(
             "--preset", options->preset,
             "iso, front, back, left, right, top or inside, without --camera (default iso)"),
         {"iso", "front", "back", "left", "right", "top", "inside"})
      ->type_name("NAME");
  app->add_option_function<std::string>(
         "--camera", [=](const std::string& s) { options->camera = numbers("--camera", s); },
         "Position, target, angle of view in degrees")
      ->type_name("px,py,pz,tx,ty,tz[,fov]");
  one_of(app->add_option_function<std::string>(
             "--up", [=](const std::string& axis) { options->up = axis[0] - 'x'; },
             "The axis that points up: x, y or z (default y)"),
         {"x", "y", "z"})
      ->type_name("AXIS");
}

void add_ray_options(CLI::App* app, TraceOptions* options) {
  app->add_option_function<std::string>(
         "--light", [=](const std::string& s) { options->light = numbers("--light", s); },
         "Position and radius of the light (default: above the scene)")
      ->type_name("x,y,z[,radius]");
  from_to(app->add_option("--samples", options->samples, "soft, ao: rays per pixel (default 64)"),
          1, 4096)
      ->type_name("N");
  app->add_option_function<std::string>(
         "--reach", [=](const std::string& s) { options->reach = number("--reach", s, 1e100); },
         "ao: length of the rays (default 0: unlimited)")
      ->type_name("LENGTH");
  app->add_option_function<std::string>(
         "--cone", [=](const std::string& s) { options->cone = number("--cone", s, 44); },
         "ao: half the angle of the cone in which rays end early, 0 to 44, for example 9 "
         "(default 0, which is exact)")
      ->type_name("DEGREES");
  app->add_flag_callback(
      "--no-beams", [=] { options->beams = false; },
      "Primary rays start at the camera (same hits)");
}

void add_output_options(CLI::App* app, TraceOptions* options) {
  takes_files(
      app->add_option("--dump", options->dump,
                      "Write 56 bytes per pixel, little-endian: u32 found, x, y, z, level, axis; "
                      "f64 t; u32 blocked rays of shadow, soft, ao; "
                      "u32 1 + layer (0: none), 0, 0"),
      {"*"})
      ->type_name("FILE");
  takes_files(app->add_option_function<std::string>(
                  "--picture",
                  [=](const std::string& name) {
                    reject_other_picture_format(name, ".ppm",
                                                "pictures are PPM: choose a name in .ppm "
                                                "(svdag-verify render: PNG)");
                    options->picture = name;
                  },
                  "Write a picture of the result"),
              {".ppm"})
      ->type_name("FILE.ppm");
}

void add_options(CLI::App* app, TraceOptions* options) {
  takes_files(app->add_option("FILE", options->file, "The .svdag file"), {".svdag"})->required();
  one_of(app->add_option("--device", options->device, "cpu or cuda (default cpu)"), {"cpu", "cuda"})
      ->type_name("NAME");
  app->add_flag("--compare", options->compare,
                "Trace on both devices and count the pixels that differ; exit 1 if any does");
  app->add_flag("--json", options->json, "Print one line of JSON instead of the table");
  add_layer(app, &options->layer);
  add_view_options(app, options);
  add_ray_options(app, options);
  from_to(app->add_option("--rounds", options->rounds,
                          "Repeat N times and report the shortest time (default 3)"),
          1, 1000)
      ->type_name("N");
  from_to(
      app->add_option("-j,--threads", options->threads, "Threads of the processor (default: all)"),
      1, 1024)
      ->type_name("N");
  add_output_options(app, options);
  add_examples(app, {"svdag-trace city.svdag --preset inside --cone 9"},
               "Sizes and pointers of the file are validated before tracing, but not its "
               "checksums: svdag-verify check proves that it is what was baked.");
}

Vec3 in_voxels(const double* point, const Header& header) {
  Vec3 v;
  for (int a = 0; a < 3; ++a) v[a] = (point[a] - header.corner[a]) / header.voxel_size;
  return v;
}

Camera make_camera(const TraceOptions& options, const PlainFile& file, const VoxelBounds& box) {
  const double aspect = double(options.width) / options.height;
  const std::vector<double>& c = options.camera;
  if (c.empty())
    return preset_camera(options.preset, file.view, box, options.up, Camera::kDefaultFov, aspect);
  if (c.size() != 6 && c.size() != 7)
    fail_usage("--camera: give px,py,pz,tx,ty,tz or px,py,pz,tx,ty,tz,fov");
  const double fov = c.size() == 7 ? c[6] : Camera::kDefaultFov;
  const Vec3 position = in_voxels(c.data(), file.header());
  const Vec3 target = in_voxels(c.data() + 3, file.header());
  const double far = length(target - position);
  if (!(fov >= 0.1 && fov <= 179))
    fail_usage("--camera: the angle of view is not 0.1 to 179 degrees");
  if (!(far > 0)) fail_usage("--camera: position and target are one point");
  if (!(far < 1e100 && length(position) < 1e100))
    fail_usage("--camera: position and target are more than 10^100 voxels away");
  return look_at(position, target, options.up, fov, aspect);
}

}  // namespace

std::optional<TraceOptions> parse_trace_options(int argc, char** argv) {
  CLI::App app(
      "Traces rays through a .svdag on the processor or a GPU, and counts them per second.",
      "svdag-trace");
  app.set_version_flag("-V,--version", "svdag-trace " SVDAG_VERSION, "Print the version and exit");
  TraceOptions options;
  add_options(&app, &options);
  if (read_command_line(&app, argc, argv)) return std::nullopt;
  return options;
}

Workload make_workload(const TraceOptions& options, const PlainFile& file) {
  if (file.view.empty()) fail_usage(options.file + ": has no voxel to trace");
  const VoxelBounds box = framing_bounds(file.view);
  Workload work{{make_camera(options, file, box), options.width, options.height}, {}, {}};
  const double diagonal = length(box.max - box.min);
  work.light.centre = (box.min + box.max) * 0.5;
  const bool inside = options.camera.empty() && options.preset == "inside";
  work.light.centre[options.up] +=
      (inside ? 0.4 : 1.5) * (box.max[options.up] - box.min[options.up]);
  work.light.radius = 0.02 * diagonal;
  if (!options.light.empty()) {
    if (options.light.size() != 3 && options.light.size() != 4)
      fail_usage("--light: give x,y,z or x,y,z,radius");
    work.light = {in_voxels(options.light.data(), file.header()),
                  options.light.size() == 4 ? options.light[3] / file.header().voxel_size : 0};
    const double radius = work.light.radius;
    if (!(length(work.light.centre) < 1e100) || !(radius >= 0 && radius < 1e100))
      fail_usage("--light: the position must be finite, the radius 0 or more");
  }
  work.secondary.samples = options.samples;
  if (options.reach > 0) work.secondary.reach = options.reach / file.header().voxel_size;
  work.secondary.cut.spread = 2 * std::tan(options.cone * 3.14159265358979323846 / 180);
  work.beams = options.beams;
  work.rounds = options.rounds;
  work.threads = options.threads;
  return work;
}

}  // namespace svdag
