#include "verify/trace/trace_options.h"

#include <charconv>
#include <cmath>
#include <cstring>

#include "streaming/error.h"
#include "verify/trace/presets.h"

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
      fail_usage(name + ": \"" + text + "\" is not numbers with commas between them");
    values.push_back(value);
    if (read.ptr == end) return values;
    at = read.ptr + 1;
  }
}

uint32_t count(const std::string& name, const std::string& text, uint32_t least, uint32_t most) {
  uint32_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || value < least ||
      value > most)
    fail_usage(name + ": \"" + text + "\" is not a number from " + std::to_string(least) + " to " +
               std::to_string(most));
  return value;
}

double number(const std::string& name, const std::string& text, double most) {
  const std::vector<double> values = numbers(name, text);
  if (values.size() != 1 || !(values[0] >= 0 && values[0] <= most))
    fail_usage(name + ": \"" + text + "\" is not a number of 0 or more that makes sense here");
  return values[0];
}

void set_size(const std::string& text, TraceOptions* options) {
  const size_t cross = text.find('x');
  if (cross == std::string::npos) fail_usage("--size: \"" + text + "\" is not WIDTHxHEIGHT");
  options->width = count("--size", text.substr(0, cross), 1, 16384);
  options->height = count("--size", text.substr(cross + 1), 1, 16384);
}

void refuse_other_pictures(const std::string& name) {
  for (const char* ending : {".png", ".jpg", ".jpeg", ".webp", ".gif", ".bmp", ".tif", ".exr"}) {
    if (name.ends_with(ending))
      fail_usage(name + ": pictures are PPM: choose a name in .ppm (svdag-verify render: PNG)");
  }
}

// An option without a value; false if it is none.
bool set_flag(const std::string& name, TraceOptions* options) {
  if (name == "--compare") return options->compare = true;
  if (name == "--help" || name == "-h") return options->help = true;
  if (name == "-V" || name == "--version") return options->version = true;
  if (name == kManualTable) return options->table = true;
  if (name == "--no-beams") return !(options->beams = false);
  return false;
}

void set_option(const std::string& name, const std::string& value, TraceOptions* options) {
  if (value.empty()) fail_usage(name + ": the value is empty");
  if (name == "--device") {
    if (value != "cpu" && value != "cuda")
      fail_usage("--device: \"" + value + "\" is not cpu or cuda");
    options->device = value;
  } else if (name == "--size") {
    set_size(value, options);
  } else if (name == "--preset") {
    options->preset = value;
  } else if (name == "--camera") {
    options->camera = numbers(name, value);
  } else if (name == "--light") {
    options->light = numbers(name, value);
  } else if (name == "--up") {
    if (value != "x" && value != "y" && value != "z")
      fail_usage("--up: \"" + value + "\" is not x, y or z");
    options->up = value[0] - 'x';
  } else if (name == "--samples") {
    options->samples = count(name, value, 1, 4096);
  } else if (name == "--rounds") {
    options->rounds = count(name, value, 1, 1000);
  } else if (name == "--threads" || name == "-j") {
    options->threads = count(name, value, 1, 1024);
  } else if (name == "--reach") {
    options->reach = number(name, value, 1e100);
  } else if (name == "--cone") {
    options->cone = number(name, value, 44);
  } else if (name == "--dump") {
    options->dump = value;
  } else if (name == "--picture") {
    refuse_other_pictures(value);
    options->picture = value;
  } else {
    fail_usage(name + ": there is no such option (--help lists them)");
  }
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
  if (!(fov > 0.1 && fov < 179) || !(far > 0 && far < 1e100))
    fail_usage("--camera: give two different points and an angle of 0.1 to 179 degrees");
  return look_at(position, target, options.up, fov, aspect);
}

}  // namespace

TraceOptions parse_trace_options(int argc, char** argv) {
  TraceOptions options;
  for (int i = 1; i < argc; ++i) {
    std::string name = argv[i], value;
    if (name.empty() || name[0] != '-') {
      if (!options.file.empty()) fail_usage(name + ": only one FILE can be traced");
      options.file = name;
      continue;
    }
    if (set_flag(name, &options)) continue;
    const size_t equals = name.find('=');
    if (equals != std::string::npos) {
      value = name.substr(equals + 1);
      name.resize(equals);
    } else if (i + 1 < argc) {
      value = argv[++i];
    } else {
      fail_usage(name + ": needs a value (--help lists the options)");
    }
    set_option(name, value, &options);
  }
  if (options.file.empty() && !options.help && !options.version && !options.table)
    fail_usage("give the .svdag to trace (--help lists the options)");
  return options;
}

Workload make_workload(const TraceOptions& options, const PlainFile& file) {
  if (file.view.empty()) fail_usage(options.file + ": has no voxel to look at");
  const VoxelBounds box = occupied_bounds(file.view);
  Workload work{{make_camera(options, file, box), options.width, options.height}, {}, {}};
  const double diagonal = length(box.max - box.min);
  work.light.centre = (box.min + box.max) * 0.5;
  work.light.centre[options.up] +=
      (options.preset == "inside" ? 0.4 : 1.5) * (box.max[options.up] - box.min[options.up]);
  work.light.radius = 0.02 * diagonal;
  if (!options.light.empty()) {
    if (options.light.size() != 3 && options.light.size() != 4)
      fail_usage("--light: give x,y,z or x,y,z,radius");
    work.light = {in_voxels(options.light.data(), file.header()),
                  options.light.size() == 4 ? options.light[3] / file.header().voxel_size : 0};
    const double radius = work.light.radius;
    if (!(length(work.light.centre) < 1e100) || !(radius >= 0 && radius < 1e100))
      fail_usage("--light: the light must be at a finite place, with a radius of 0 or more");
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
