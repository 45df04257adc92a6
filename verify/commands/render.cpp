#include "verify/commands/render.h"

#include <charconv>
#include <cstdio>

#include "io/dag/dag_file.h"
#include "streaming/error.h"
#include "streaming/file.h"

namespace svdag {
namespace {

ShadeMode parse_mode(const std::string& mode) {
  if (mode == "primary") return ShadeMode::kPrimary;
  if (mode == "shadow") return ShadeMode::kShadow;
  if (mode == "normal") return ShadeMode::kNormal;
  if (mode == "depth") return ShadeMode::kDepth;
  fail_usage("--mode: \"" + mode + "\" is not primary, shadow, normal or depth");
}

// The camera of --camera, given in the world, or one that frames everything.
Camera make_camera(const RenderCommandConfig& config, const Grid& grid, int up, double aspect,
                   const VoxelBounds& box) {
  const std::vector<double>& c = config.camera;
  if (c.empty()) return frame_box(box, up, Camera::kDefaultFov, aspect);
  if (c.size() != 6 && c.size() != 7)
    fail_usage("--camera: give px,py,pz,tx,ty,tz or px,py,pz,tx,ty,tz,fov");
  const double fov = c.size() == 7 ? c[6] : Camera::kDefaultFov;
  if (!(fov > 0.1 && fov < 179))
    fail_usage("--camera: the angle of view is not 0.1 to 179 degrees");
  const Point corner = grid.corner();
  Vec3 position, target;
  for (int a = 0; a < 3; ++a) {
    position[a] = (c[size_t(a)] - corner[a]) / grid.voxel_size;
    target[a] = (c[size_t(a) + 3] - corner[a]) / grid.voxel_size;
  }
  const Vec3 d = target - position;
  if (!(dot(d, d) > 0 && dot(d, d) < 1e300))
    fail_usage("--camera: position and target must be two different, finite points");
  return look_at(position, target, up, fov, aspect);
}

}  // namespace

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
  const size_t up = std::string("xyz").find(config.up);
  if (config.up.size() != 1 || up == std::string::npos)
    fail_usage("--up: \"" + config.up + "\" is not x, y or z");
  const ShadeMode mode = parse_mode(config.mode);
  if (same_file(config.file, config.output))
    fail_usage(config.output + ": is the input; choose another name for the picture");

  const DagFile file = DagFile::open(config.file);
  if (file.view().empty()) fail_usage(file.path() + ": has no voxel to look at");
  const VoxelBounds box = occupied_bounds(file.view());
  const double aspect = double(picture.width) / picture.height;
  const Camera camera = make_camera(config, file.grid(), int(up), aspect, box);
  const Shading shading = make_shading(mode, camera, int(up), box);
  ParallelExecutor executor(config.common.threads ? config.common.threads : available_processors());
  Progress progress(config.common.progress);
  write_png(render(file.view(), camera, shading, picture, executor, progress), config.output);
  if (!config.common.quiet)
    std::printf("%s: %dx%d, %s\n", config.output.c_str(), picture.width, picture.height,
                config.mode.c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
