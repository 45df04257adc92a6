#include "verify/trace/presets.h"

#include <cmath>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr double kPi = 3.14159265358979323846;

bool holds(const VoxelBounds& box, const Vec3& point) {
  bool inside = true;
  for (int a = 0; a < 3; ++a) inside = inside && point[a] >= box.min[a] && point[a] <= box.max[a];
  return inside;
}

// From the middle back along the longer horizontal axis, as far as nothing is in the way.
Camera inside_view(const DagView& dag, const VoxelBounds& box, int up, double aspect) {
  constexpr double kWide = 75, kFarthest = 0.4, kLow = 0.3;
  const Vec3 size = box.max - box.min;
  const int one = (up + 1) % 3, two = (up + 2) % 3;
  const int along = size[one] > size[two] ? one : two;
  Vec3 middle = (box.min + box.max) * 0.5, back{};
  middle[up] = box.min[up] + kLow * size[up];
  back[along] = -1;
  const Hit wall = trace_closest(dag, {middle, back}, {0, kFarthest * size[along]});
  const double far = 0.95 * (wall.found ? wall.t : kFarthest * size[along]);
  return look_at(middle + back * far, middle - back * size[along], up, kWide, aspect);
}

}  // namespace

Camera preset_camera(const std::string& name, const DagView& dag, const VoxelBounds& box, int up,
                     double fov, double aspect) {
  if (name == "inside") return inside_view(dag, box, up, aspect);
  Vec3 towards{};  // from the box to the camera; front looks along the axis after `up`, reversed
  const int depth = up == 1 ? 2 : (up + 2) % 3, across = 3 - up - depth;
  const double near = up == 1 ? 1 : -1;  // y up: front is +z, as in glTF; z up: front is -y
  if (name == "iso") {
    towards[up] = 0.55;
    towards[depth] = near;
    towards[across] = 0.62;
  } else if (name == "front" || name == "back") {
    towards[depth] = name == "front" ? near : -near;
  } else if (name == "left" || name == "right") {
    towards[across] = name == "right" ? 1 : -1;
  } else if (name == "top") {
    towards[up] = 1;
  } else {
    fail_usage("--preset: \"" + name + "\" is not iso, front, back, left, right, top or inside");
  }
  return frame_box(box, towards, up, fov, aspect);
}

Camera turned(const Camera& camera, const VoxelBounds& box, int up, int frame, int frames) {
  const double angle = 2 * kPi * frame / frames, c = std::cos(angle), s = std::sin(angle);
  const int x = (up + 1) % 3, y = (up + 2) % 3;
  const auto turn = [&](Vec3 v) {
    const double vx = v[x], vy = v[y];
    v[x] = c * vx - s * vy;
    v[y] = s * vx + c * vy;
    return v;
  };
  Camera result = camera;
  result.right = turn(camera.right);
  result.up = turn(camera.up);
  result.forward = turn(camera.forward);
  if (holds(box, camera.position)) return result;
  const Vec3 centre = (box.min + box.max) * 0.5;
  result.position = centre + turn(camera.position - centre);
  return result;
}

}  // namespace svdag
