#include "verify/trace/view_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "io/help/command_line.h"
#include "streaming/error.h"
#include "streaming/file/file_ending.h"
#include "verify/trace/presets.h"

namespace svdag {
namespace {

std::vector<double> parse_numbers(const std::string& option, const std::string& text) {
  std::vector<double> values;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    double value = 0;
    const auto read = std::from_chars(at, end, value);
    if (read.ec != std::errc() || !std::isfinite(value) || (read.ptr != end && *read.ptr != ','))
      fail_usage(option + ": \"" + text + "\" is not a list of finite numbers separated by commas");
    values.push_back(value);
    if (read.ptr == end) return values;
    at = read.ptr + 1;
  }
}

double parse_below(const std::string& option, const std::string& text, double end,
                   const char* what) {
  double value = -1;
  const char* const last = text.data() + text.size();
  const auto read = std::from_chars(text.data(), last, value);
  if (read.ec != std::errc() || read.ptr != last || !(value >= 0 && value < end))
    fail_usage(option + ": \"" + text + "\" is not " + what);
  return value;
}

PictureSize parse_picture_size(const std::string& text) {
  PictureSize size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  const bool cross = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  const auto height = std::from_chars(cross ? width.ptr + 1 : end, end, size.height);
  if (!cross || height.ec != std::errc() || height.ptr != end || size.width < 1 ||
      size.height < 1 || size.width > 16384 || size.height > 16384)
    fail_usage("--size: \"" + text + "\" is not WIDTHxHEIGHT with 1 to 16384 pixels each");
  return size;
}

// Converts the point (c[0], c[1], c[2]) from scene units to voxels.
Vec3 point_in_voxels(const double* c, const DagView& dag) {
  Vec3 point;
  for (int a = 0; a < 3; ++a) point[a] = voxel_from_world(dag, a, c[a]);
  return point;
}

}  // namespace

void add_size(CLI::App* app, PictureSize* size, const std::string& pixels) {
  app->add_option_function<std::string>(
         "--size", [=](const std::string& text) { *size = parse_picture_size(text); },
         pixels + ", 1 to 16384 each way (default " + std::to_string(size->width) + "x" +
             std::to_string(size->height) + ")")
      ->type_name("WxH");
}

void add_up(CLI::App* app, int* up) {
  one_of(app->add_option_function<std::string>(
             "--up", [=](const std::string& axis) { *up = axis[0] - 'x'; },
             "The axis that points up: x, y or z (default y)"),
         {"x", "y", "z"})
      ->type_name("AXIS");
}

void add_camera(CLI::App* app, ViewOptions* view) {
  add_size(app, &view->size);
  app->add_option_function<std::string>(
         "--camera",
         [=](const std::string& text) { view->camera = parse_numbers("--camera", text); },
         "Position and target in scene units, angle of view in degrees, 0.1 to 179 (default: "
         "frames all)")
      ->type_name("px,py,pz,tx,ty,tz[,fov]");
  one_of(app->add_option(
             "--preset", view->preset,
             "iso, front, back, left, right, top or inside, without --camera (default iso)"),
         {"iso", "front", "back", "left", "right", "top", "inside"})
      ->type_name("NAME");
  add_up(app, &view->up);
}

void add_rays(CLI::App* app, ViewOptions* view, const RayDefaults& defaults) {
  app->add_option_function<std::string>(
         "--light", [=](const std::string& text) { view->light = parse_numbers("--light", text); },
         "Position and radius of the light in scene units (default: " + defaults.light + ")")
      ->type_name("x,y,z[,radius]");
  from_to(app->add_option("--samples", view->samples,
                          "soft, ao: rays to the light or sky for each camera ray (default " +
                              defaults.samples + ")"),
          1, 4096)
      ->type_name("N");
  app->add_option_function<std::string>(
         "--reach",
         [=](const std::string& text) {
           view->reach = parse_below("--reach", text, 1e100, "a length of 0 or more");
         },
         "ao: length of the rays in scene units (default: " + defaults.reach + ")")
      ->type_name("LENGTH");
  app->add_option_function<std::string>(
         "--cone",
         [=](const std::string& text) {
           view->cone = parse_below("--cone", text, 45, "an angle from 0 to less than 45 degrees");
         },
         "soft, ao: half the angle, from 0 and below 45, of the cone in which rays end early "
         "(default: " +
             defaults.cone + ")")
      ->type_name("DEGREES");
}

Camera camera_of(const ViewOptions& view, const DagView& dag, const VoxelBounds& box) {
  const double aspect = view.size.aspect();
  const std::vector<double>& c = view.camera;
  if (c.empty()) return preset_camera(view.preset, dag, box, view.up, Camera::kDefaultFov, aspect);
  if (c.size() != 6 && c.size() != 7)
    fail_usage("--camera: give px,py,pz,tx,ty,tz or px,py,pz,tx,ty,tz,fov");
  const double fov = c.size() == 7 ? c[6] : Camera::kDefaultFov;
  if (!(fov >= 0.1 && fov <= 179))
    fail_usage("--camera: the angle of view is not 0.1 to 179 degrees");
  const Vec3 position = point_in_voxels(c.data(), dag), target = point_in_voxels(&c[3], dag);
  const double far = length(target - position);
  if (!(far > 0)) fail_usage("--camera: position and target are one point");
  if (!(far < 1e100 && length(position) < 1e100))
    fail_usage("--camera: position and target are more than 10^100 voxels away");
  return look_at(position, target, view.up, fov, aspect);
}

void apply_light(const ViewOptions& view, const DagView& dag, Light* light) {
  if (view.light.empty()) return;
  if (view.light.size() != 3 && view.light.size() != 4)
    fail_usage("--light: give x,y,z or x,y,z,radius");
  light->centre = point_in_voxels(view.light.data(), dag);
  light->radius = view.light.size() == 4 ? view.light[3] / dag.voxel_size : 0;
  if (!(length(light->centre) < 1e100) || !(light->radius >= 0 && light->radius < 1e100))
    fail_usage("--light: the position must be finite, the radius 0 or more");
}

void apply_rays(const ViewOptions& view, const DagView& dag, Secondary* secondary) {
  if (view.samples) secondary->samples = *view.samples;
  if (view.reach > 0) secondary->reach = view.reach / dag.voxel_size;
  if (view.cone) secondary->cut.spread = cone_spread(*view.cone);
}

double cone_spread(double degrees) {
  return 2 * std::tan(degrees * kPi / 180);
}

void reject_other_picture_format(const std::string& name, const std::string& written,
                                 const std::string& sentence) {
  for (const char* ending : {".png", ".ppm", ".jpg", ".jpeg", ".webp", ".gif", ".bmp", ".tif",
                             ".tiff", ".exr", ".hdr", ".tga"}) {
    if (ending != written && has_ending(name, ending)) fail_usage(name + ": " + sentence);
  }
}

}  // namespace svdag
