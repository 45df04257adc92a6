#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "io/dag/dag_file.h"
#include "io/dag/open_dag.h"
#include "io/dag/walk/cube_at.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/printable.h"
#include "verify/commands/commands.h"
#include "verify/trace/cpu.h"
#include "verify/trace/kernel/tree64.h"
#include "verify/trace/presets.h"

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

// The first camera. A camera that flies keeps the whole box in view, and so does one of frames.
Camera first_camera(const RenderCommandConfig& config, const DagView& dag, const VoxelBounds& box) {
  const ViewOptions& view = config.view;
  if (!view.camera.empty() || view.preset == "inside") return camera_of(view, dag, box);
  if (config.fly) return camera_of(view, {}, turntable_bounds(box, view.up));
  return camera_of(view, config.frames ? DagView{} : dag, box);
}

// Applies the options of light and rays, and --level.
void apply(const RenderCommandConfig& config, const DagView& dag, const Camera& camera,
           const VoxelBounds& box, Shading* shading) {
  shading->pixel = 2 * camera.slope / config.view.size.height;
  shading->grid_lines = config.grid_lines;
  apply_light(config.view, dag, &shading->light);
  const uint64_t level = config.level.value_or(uint64_t(dag.levels));
  if (level == 0 || level > uint64_t(dag.levels))
    fail_usage("--level: " + config.file + " has levels 1 to " + std::to_string(dag.levels) +
               " to trace");
  const bool ao = shading->mode == ShadeMode::kAo;
  Secondary& secondary = shading->secondary;
  secondary.reach = 0.05 * length(box.max - box.min);
  secondary.cut.spread = ao ? cone_spread(9) : 0;
  secondary.samples = ao ? 64 : 16;  // 16 of the whole sky are noise
  apply_rays(config.view, dag, &secondary);
  if (!ao && shading->mode != ShadeMode::kSoft) secondary.cut.spread = 0;
  if (config.level) shading->primary.level = secondary.cut.level = uint32_t(level);
  if (shading->mode == ShadeMode::kLevel) shading->primary.spread = shading->pixel;
}

// Reports a camera in a voxel that is set, since all it sees is that voxel.
void report_camera_in_matter(const DagView& dag, const Vec3& camera, const VoxelBox& shown) {
  const double side = double(uint64_t(1) << dag.levels);
  for (int a = 0; a < 3; ++a) {
    if (!(camera[a] >= 0 && camera[a] < side)) return;
  }
  const LatticePoint voxel(camera[0], camera[1], camera[2]);
  const bool is_shown = shown.holds({voxel, voxel + int64_t(1)});
  if (is_shown && cube_at(dag, voxel).set)
    std::fprintf(stderr,
                 "svdag-verify: the camera is in matter: voxel %lld, %lld, %lld is all that it "
                 "sees\n",
                 static_cast<long long>(voxel.x), static_cast<long long>(voxel.y),
                 static_cast<long long>(voxel.z));
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

// The output, or with --fly or --frames the name of a frame: "fly_0007.png" for "fly.png" and
// frame 6.
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

int run(const RenderCommandConfig& config) {
  const Stopwatch stopwatch(config.common);
  const int up = config.view.up;
  RenderConfig picture;
  picture.width = config.view.size.width;
  picture.height = config.view.size.height;
  picture.supersample = config.supersample;
  if (picture.supersample < 1 || picture.supersample > 16)
    fail_usage("--supersample: give 1 to 16 rays across a pixel");
  if (config.fly && (*config.fly < 1 || *config.fly > 9999))
    fail_usage("--fly: give 1 to 9999 frames");
  if (!config.mode.empty()) parse_mode(config.mode);
  const DagFile file = open_dag(config.file, config.selection);
  const bool coloured = (file.has_colours() || !file.layers().empty()) && !config.frames;
  if (config.frames && file.layers().empty())
    fail_usage("--frames: " + file.path() + " has no layers (svdag build --layers)");
  const int frames = config.frames ? int(file.layers().layers.size()) : config.fly.value_or(1);
  CommandFiles files({config.file});
  for (int frame = 0; frame < frames; ++frame) {
    const std::string name = picture_name(config, frame);
    files.write(name);
    reject_other_picture_format(name, ".png", "pictures are PNG: choose a name in .png");
    AtomicFile::check(name);
  }

  const std::string mode_name = !config.mode.empty() ? config.mode
                                : coloured           ? "colour"
                                                     : "primary";
  const ShadeMode mode = parse_mode(mode_name);
  if (mode == ShadeMode::kColour && !coloured)
    fail_usage("--mode colour: " + file.path() +
               " has neither colours nor layers (svdag build --colours, --layers)");
  picture.beams = mode != ShadeMode::kSteps;  // beams would hide steps
  const ShownColours colours(file);
  if (coloured) colours.show_in(&picture);
  if (file.view().empty()) fail_usage(file.path() + ": has no voxel to trace");
  VoxelBox shown = config.clip ? clipped_voxels(file.grid(), *config.clip) : file.grid().whole();
  VoxelBounds whole = framing_bounds(file.view());
  for (int frame = 0; config.frames && frame < frames; ++frame)
    whole = framing_bounds(file.view_of(size_t(frame)), whole);
  const VoxelBounds box = clipped_bounds(whole, shown);
  const Camera first = first_camera(config, file.view(), box);
  if (!config.slice.empty()) slice(config.slice, file.view(), first.position, &shown);
  if (config.clip || !config.slice.empty()) picture.clip = clip_box(shown);
  if (!config.frames && !config.fly) report_camera_in_matter(file.view(), first.position, shown);
  // The light does not move with the camera.
  const Light light = make_shading(mode, file.view(), first, up, box).light;
  ParallelExecutor executor(threads_or_all(config.common.threads));
  Progress progress(config.common.progress);
  Tree64 tree;
  for (int frame = 0; frame < frames; ++frame) {
    const DagView dag = config.frames ? file.view_of(size_t(frame)) : file.view();
    const Camera camera = config.fly ? turned(first, box, up, frame, frames) : first;
    Shading shading = make_shading(mode, dag, camera, up, box);
    shading.light = light;
    apply(config, dag, camera, box, &shading);
    if (frame == 0 && !config.frames &&
        mode != ShadeMode::kSteps)  // shows the steps of the DAG's traversal
      tree = tree_if_it_pays(
          file.view(),
          uncut_rays(file.view(), shading, picture) * uint64_t(frames) / executor.workers(),
          default_memory_limit());
    const std::string name = picture_name(config, frame);
    write_png(render(dag, tree.view(), camera, shading, picture, executor, progress), name);
    if (!config.common.quiet)
      std::printf("%s: %dx%d, %s\n", printable(name).c_str(), picture.width, picture.height,
                  mode_name.c_str());
  }
  return int(ExitCode::kOk);
}

}  // namespace svdag
