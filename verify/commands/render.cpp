#include "verify/commands/render.h"
#include "io/pack/unpack.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "io/dag/dag_file.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"
#include "verify/trace/kernel/tree64.h"
#include "verify/trace/program/picture_name.h"
#include "verify/trace/program/presets.h"

namespace svdag {
namespace {

ShadeMode parse_mode(const std::string& mode) {
  constexpr const char* kNames[] = {"primary", "shadow", "soft",  "ao",    "normal",
                                    "depth",   "level",  "steps", "colour"};
  for (int i = 0; i < int(std::size(kNames)); ++i) {
    if (mode == kNames[i]) return ShadeMode(i);
  }
  fail_usage("--mode: \"" + mode +
             "\" is not primary, shadow, soft, ao, normal, depth, level, steps or colour");
}

// Converts the point (c[0], c[1], c[2]) from scene units to voxels.
Vec3 in_voxels(const double* c, const DagView& dag) {
  Vec3 point;
  for (int a = 0; a < 3; ++a) point[a] = voxel_from_world(dag, a, c[a]);
  return point;
}

// The camera of --camera, or that of --preset.
Camera make_camera(const RenderCommandConfig& config, const DagFile& file, int up, double aspect,
                   const VoxelBounds& box) {
  const std::vector<double>& c = config.camera;
  if (c.empty() && config.fly && config.preset != "inside")
    return preset_camera(config.preset, {}, turntable_bounds(box, up), up, Camera::kDefaultFov,
                         aspect);
  if (c.empty())
    return preset_camera(config.preset, file.view(), box, up, Camera::kDefaultFov, aspect);
  if (c.size() != 6 && c.size() != 7)
    fail_usage("--camera: give px,py,pz,tx,ty,tz or px,py,pz,tx,ty,tz,fov");
  const double fov = c.size() == 7 ? c[6] : Camera::kDefaultFov;
  if (!(fov >= 0.1 && fov <= 179))
    fail_usage("--camera: the angle of view is not 0.1 to 179 degrees");
  const Vec3 position = in_voxels(c.data(), file.view()),
             target = in_voxels(c.data() + 3, file.view());
  const Vec3 d = target - position;
  if (!(dot(d, d) > 0 && dot(d, d) < 1e300))
    fail_usage("--camera: position and target must be two different, finite points");
  return look_at(position, target, up, fov, aspect);
}

// Applies --light, --samples, --reach, --cone and --level.
void apply(const RenderCommandConfig& config, const DagView& dag, const Camera& camera,
           const VoxelBounds& box, int height, Shading* shading) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  shading->pixel = 2 * camera.slope / height;
  shading->grid_lines = config.grid_lines;
  if (!config.light.empty()) {
    if (config.light.size() != 3 && config.light.size() != 4)
      fail_usage("--light: give x,y,z or x,y,z,radius");
    shading->light = {in_voxels(config.light.data(), dag),
                      config.light.size() == 4 ? config.light[3] / dag.voxel_size : 0};
    const double far = length(shading->light.centre);
    if (!(far < 1e100) || !(shading->light.radius >= 0 && shading->light.radius < 1e100))
      fail_usage("--light: the position must be finite, the radius 0 or more");
  }
  if (config.samples < 1 || config.samples > 4096)
    fail_usage("--samples: give 1 to 4096 rays to the light for each camera ray");
  const bool ao = shading->mode == ShadeMode::kAo;
  const double cone = config.cone.value_or(ao ? 9 : 0);
  if (!(cone >= 0 && cone < 45)) fail_usage("--cone: give 0 degrees or more, and less than 45");
  if (!(config.reach >= 0)) fail_usage("--reach: give a length of 0 or more");
  const uint64_t level = config.level.value_or(uint64_t(dag.levels));
  if (level == 0 || level > uint64_t(dag.levels))
    fail_usage("--level: " + config.file + " has levels 1 to " + std::to_string(dag.levels) +
               " to trace");
  shading->secondary.samples = uint32_t(config.samples);
  shading->secondary.reach =
      config.reach > 0 ? config.reach / dag.voxel_size : 0.05 * length(box.max - box.min);
  if (ao || shading->mode == ShadeMode::kSoft)
    shading->secondary.cut.spread = 2 * std::tan(cone * kDegree);
  if (config.level) shading->primary.level = shading->secondary.cut.level = uint32_t(level);
  if (shading->mode == ShadeMode::kLevel) shading->primary.spread = shading->pixel;
}

// The voxels that --clip shows.
VoxelBox clipped_voxels(const Grid& grid, const Box& bounds) {
  const VoxelBox voxels = select_bounds(grid, bounds).selection;
  if (voxels.empty()) fail_usage("--clip: contains no voxel of the grid");
  return voxels;
}

// Parses "z=1.5".
std::pair<int, double> parse_plane(const std::string& text) {
  const size_t axis = std::string("xyz").find(text.substr(0, 1));
  const char* const end = text.data() + text.size();
  double value = 0;
  bool good = text.size() > 2 && text[1] == '=' && axis < 3;
  if (good) {
    const auto parsed = std::from_chars(text.data() + 2, end, value);
    good = parsed.ec == std::errc() && parsed.ptr == end && std::isfinite(value);
  }
  if (!good) fail_usage("--slice: \"" + text + "\" is not an axis and a position, such as z=1.5");
  return {int(axis), value};
}

// Restricts `box` to the layer of the plane of --slice and all voxels beyond it, seen from
// `camera`.
void slice(const std::string& text, const DagView& dag, const Vec3& camera, VoxelBox* box) {
  const auto [axis, value] = parse_plane(text);
  const double layer = std::floor(voxel_from_world(dag, axis, value));
  if (!(layer >= double(box->min[axis]) && layer < double(box->max[axis])))
    fail_usage("--slice " + text + ": the plane does not cut the voxels that are shown");
  if (camera[axis] > layer)
    box->max[axis] = int64_t(layer) + 1;
  else
    box->min[axis] = int64_t(layer);
}

ClipBox clip_box(const VoxelBox& box) {
  ClipBox clip;
  for (int a = 0; a < 3; ++a) {
    clip.min[a] = uint32_t(box.min[a]);
    clip.max[a] = uint32_t(box.max[a]);
  }
  return clip;
}

// The part of `box` that --clip shows, for framing.
VoxelBounds clipped_bounds(VoxelBounds box, const VoxelBox& voxels) {
  VoxelBounds shown = box;
  for (int a = 0; a < 3; ++a) {
    shown.min[a] = std::max(box.min[a], double(voxels.min[a]));
    shown.max[a] = std::min(box.max[a], double(voxels.max[a]));
    if (shown.min[a] >= shown.max[a]) return box;
  }
  return shown;
}

// The output, or with --fly or --frames that of a frame: "fly_0007.png" for "fly.png" and frame 6.
std::string picture_name(const RenderCommandConfig& config, int frame) {
  const std::string& path = config.output;
  if (!config.fly && !config.frames) return path;
  const size_t dot = path.rfind(".png");
  const bool has_ending = dot != std::string::npos && dot + 4 == path.size();
  char number[16];
  std::snprintf(number, sizeof number, "_%04d", frame + 1);
  return (has_ending ? path.substr(0, dot) : path) + number + ".png";
}

}  // namespace

LayerColours::LayerColours(const DagFile& file) {
  if (file.layers().empty()) return;
  index_.emplace(file.layer_index());
  for (const Layer& layer : file.layers().layers) albedos_.push_back(albedo_of(layer.colour));
}

void LayerColours::show_in(RenderConfig* picture) const {
  if (!index_) return;
  picture->layers = index_->view();
  picture->albedos = albedos_;
}

RenderConfig parse_size(const std::string& size) {
  RenderConfig config;
  const char* end = size.data() + size.size();
  const auto width = std::from_chars(size.data(), end, config.width);
  const bool cross = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  const auto height = std::from_chars(cross ? width.ptr + 1 : end, end, config.height);
  if (!cross || height.ec != std::errc() || height.ptr != end || config.width < 1 ||
      config.height < 1 || config.width > 16384 || config.height > 16384)
    fail_usage("--size: \"" + size + "\" is not WIDTHxHEIGHT with 1 to 16384 pixels each");
  return config;
}

int run(const RenderCommandConfig& config) {
  const Stopwatch stopwatch(config.common);
  RenderConfig picture = parse_size(config.size);
  picture.supersample = config.supersample;
  if (picture.supersample < 1 || picture.supersample > 16)
    fail_usage("--supersample: give 1 to 16 rays across a pixel");
  if (config.fly && (*config.fly < 1 || *config.fly > 9999))
    fail_usage("--fly: give 1 to 9999 frames");
  const size_t up = std::string("xyz").find(config.up);
  if (config.up.size() != 1 || up == std::string::npos)
    fail_usage("--up: \"" + config.up + "\" is not x, y or z");
  if (!config.mode.empty()) parse_mode(config.mode);
  const DagFile file = open_dag(config.file, config.layer);
  const bool layered = !file.layers().empty() && !config.frames;
  if (config.frames && file.layers().empty())
    fail_usage("--frames: " + file.path() + " has no layers (svdag build --layers)");
  const int frames = config.frames ? int(file.layers().layers.size()) : config.fly.value_or(1);
  for (int frame = 0; frame < frames; ++frame) {
    const std::string name = picture_name(config, frame);
    if (same_file(config.file, name))
      fail_usage(name + ": is the input; choose another name for the picture");
    reject_other_picture_format(name, ".png", "pictures are PNG: choose a name in .png");
    AtomicFile::check(name);
  }

  const std::string mode_name = !config.mode.empty() ? config.mode : layered ? "colour" : "primary";
  const ShadeMode mode = parse_mode(mode_name);
  if (mode == ShadeMode::kColour && !layered)
    fail_usage("--mode colour: " + file.path() + " has no layers (svdag build --layers)");
  picture.beams = mode != ShadeMode::kSteps;  // beams would hide steps
  const LayerColours colours(file);
  if (layered) colours.show_in(&picture);
  if (file.view().empty()) fail_usage(file.path() + ": has no voxel to trace");
  VoxelBox shown = config.clip ? clipped_voxels(file.grid(), *config.clip) : file.grid().whole();
  const VoxelBounds box = clipped_bounds(framing_bounds(file.view()), shown);
  const double aspect = double(picture.width) / picture.height;
  const Camera first = make_camera(config, file, int(up), aspect, box);
  if (!config.slice.empty()) slice(config.slice, file.view(), first.position, &shown);
  if (config.clip || !config.slice.empty()) picture.clip = clip_box(shown);
  // The light does not move with the camera.
  const Light light = make_shading(mode, file.view(), first, int(up), box).light;
  ParallelExecutor executor(threads_or_all(config.common.threads));
  Progress progress(config.common.progress);
  Tree64 tree;
  for (int frame = 0; frame < frames; ++frame) {
    const DagView dag = config.frames ? file.view_of(size_t(frame)) : file.view();
    const Camera camera = config.fly ? turned(first, box, int(up), frame, frames) : first;
    Shading shading = make_shading(mode, dag, camera, int(up), box);
    shading.light = light;
    apply(config, dag, camera, box, picture.height, &shading);
    if (frame == 0 && !config.frames &&
        mode != ShadeMode::kSteps)  // shows the steps of the DAG's traversal
      tree = tree_if_it_pays(
          file.view(),
          uncut_rays(file.view(), shading, picture) * uint64_t(frames) / executor.workers(),
          default_memory_limit());
    const std::string name = picture_name(config, frame);
    write_png(render(dag, tree.view(), camera, shading, picture, executor, progress), name);
    if (!config.common.quiet)
      std::printf("%s: %dx%d, %s\n", name.c_str(), picture.width, picture.height,
                  mode_name.c_str());
  }
  return int(ExitCode::kOk);
}

}  // namespace svdag
