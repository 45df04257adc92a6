#include "verify/trace/kernel/camera.h"

#include <algorithm>
#include <cmath>

namespace svdag {
namespace {

constexpr uint32_t kBoundsLevel = 8;
constexpr double kMargin = 1.04;

double slope_of(double fov) {
  return std::tan(fov * 3.14159265358979323846 / 360);
}

// Grows `box` around the node's descendants of level kBoundsLevel; skips cubes inside `box`.
void grow(const DagView& dag, uint32_t level, uint32_t node, const Vec3& corner, VoxelBounds* box) {
  const double side = double(1U << (dag.levels - level));
  bool inside = box->min[0] < box->max[0];
  for (int a = 0; a < 3; ++a)
    inside = inside && box->min[a] <= corner[a] && corner[a] + side <= box->max[a];
  if (inside) return;
  if (level == std::min(kBoundsLevel, dag.brick_level())) {
    const bool first = box->min[0] >= box->max[0];
    for (int a = 0; a < 3; ++a) {
      box->min[a] = first ? corner[a] : std::min(box->min[a], corner[a]);
      box->max[a] = first ? corner[a] + side : std::max(box->max[a], corner[a] + side);
    }
    return;
  }
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t child = dag_child(dag, level, node, c);
    const Vec3 offset{{double(c >> 2), double(c >> 1 & 1), double(c & 1)}};
    if (child != kNoChild) grow(dag, level + 1, child, corner + offset * (side / 2), box);
  }
}

}  // namespace

std::array<Vec3, 8> corners_of(const VoxelBounds& box) {
  std::array<Vec3, 8> corners;
  for (size_t i = 0; i < 8; ++i)
    corners[i] = {{i & 1 ? box.max[0] : box.min[0], i & 2 ? box.max[1] : box.min[1],
                   i & 4 ? box.max[2] : box.min[2]}};
  return corners;
}

Camera look_at(const Vec3& position, const Vec3& target, int up, double fov, double aspect) {
  Camera camera{position, {}, {}, normalized(target - position), slope_of(fov), aspect};
  Vec3 world_up{};
  world_up[up] = 1;
  camera.right = cross(camera.forward, world_up);
  // Straight up or down: any horizontal direction is right.
  if (dot(camera.right, camera.right) < 1e-12) {
    camera.right = Vec3{};
    camera.right[up == 0 ? 1 : 0] = 1;
  }
  camera.right = normalized(camera.right);
  camera.up = cross(camera.right, camera.forward);
  return camera;
}

Camera frame_box(const VoxelBounds& box, const Vec3& towards, int up, double fov, double aspect) {
  const Vec3 center = (box.min + box.max) * 0.5;
  Camera camera = look_at(center + towards, center, up, fov, aspect);
  // The smallest distance at which every corner of the box projects into the image.
  double distance = 0;
  for (const Vec3& corner : corners_of(box)) {
    const Vec3 d = corner - center;
    const double depth = dot(d, camera.forward);
    const double h = std::abs(dot(d, camera.right)) / (camera.slope * aspect);
    const double v = std::abs(dot(d, camera.up)) / camera.slope;
    distance = std::max(distance, std::max(h, v) * kMargin - depth);
  }
  camera.position = center - camera.forward * distance;
  return camera;
}

VoxelBounds framing_bounds(const DagView& dag) {
  VoxelBounds box;
  if (!dag.empty()) grow(dag, 0, 0, {}, &box);
  return box;
}

}  // namespace svdag
