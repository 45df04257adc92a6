#include "verify/trace/kernel/camera.h"

#include <algorithm>
#include <cmath>

#include "verify/trace/kernel/surface.h"

namespace svdag {
namespace {

constexpr uint32_t kBoundsLevel = 8;
constexpr double kMargin = 1.04;
constexpr double kFramingCubes = 128;  // along the longest side of the box

double slope_of(double fov) {
  return std::tan(fov * kPi / 360);
}

// The nearest camera that shows all cubes that were added, for a fixed direction of view.
//
// With h, d = the coordinates of a point along `right` and `forward`, and a = tangent of half the
// angle of view, the camera at h = c, d = -D shows the point iff |h - c| <= a (d + D). Over all
// points: D >= (max(h - a d) + max(-h - a d)) / 2a, with c in the middle. The same for `up`.
class Framing {
 public:
  Framing(const VoxelBounds& box, const Vec3& towards, int up, double fov, double aspect)
      : centre_((box.min + box.max) * 0.5),
        camera_(look_at(centre_ + towards, centre_, up, fov, aspect)),
        horizontal_(camera_.right, camera_.forward, camera_.slope * aspect / kMargin),
        vertical_(camera_.up, camera_.forward, camera_.slope / kMargin) {}

  void add(const Vec3& cube, double half_side) {
    horizontal_.add(cube - centre_, half_side);
    vertical_.add(cube - centre_, half_side);
  }

  Camera camera() const {
    Camera camera = camera_;
    const double distance = std::max(horizontal_.distance(), vertical_.distance());
    camera.position = centre_ + camera.right * horizontal_.middle() +
                      camera.up * vertical_.middle() - camera.forward * distance;
    return camera;
  }

 private:
  // One direction of the image. The extrema are of linear functions, so those of a cube follow from
  // its centre.
  class Extent {
   public:
    Extent(const Vec3& axis, const Vec3& forward, double slope)
        : plus_(axis - forward * slope), minus_(axis * -1 - forward * slope), slope_(slope) {}
    void add(const Vec3& p, double half_side) {
      max_plus_ = std::max(max_plus_, dot(p, plus_) + half_side * sum_of(plus_));
      max_minus_ = std::max(max_minus_, dot(p, minus_) + half_side * sum_of(minus_));
    }
    double distance() const { return (max_plus_ + max_minus_) / (2 * slope_); }
    double middle() const { return (max_plus_ - max_minus_) / 2; }

   private:
    static double sum_of(const Vec3& v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }
    Vec3 plus_, minus_;
    double slope_, max_plus_ = -1e300, max_minus_ = -1e300;
  };

  Vec3 centre_;
  Camera camera_;
  Extent horizontal_, vertical_;
};

struct FramedBox {
  VoxelBounds box;
  double finest;  // cubes of at most this side are added whole
};

// Adds the occupied cubes below `node` that meet the box.
void add_cubes(const DagView& dag, uint32_t level, uint32_t node, const Vec3& corner,
               const FramedBox& framed, Framing* framing) {
  const double side = double(1U << (dag.levels - level));
  for (int a = 0; a < 3; ++a) {
    if (corner[a] >= framed.box.max[a] || corner[a] + side <= framed.box.min[a]) return;
  }
  if (side <= framed.finest)
    return framing->add(corner + Vec3{{side / 2, side / 2, side / 2}}, side / 2);
  if (level == dag.brick_level()) {
    for (int bit = 0; bit < 64; ++bit) {
      if ((dag.bricks[node] >> bit & 1) == 0) continue;
      Vec3 centre = corner + Vec3{{0.5, 0.5, 0.5}};
      for (int a = 0; a < 3; ++a) centre[a] += brick_coordinate(bit, a);
      framing->add(centre, 0.5);
    }
    return;
  }
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t child = dag_child(dag, level, node, c);
    const Vec3 offset{{double(c >> 2), double(c >> 1 & 1), double(c & 1)}};
    if (child != kNoChild)
      add_cubes(dag, level + 1, child, corner + offset * (side / 2), framed, framing);
  }
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

Camera frame_voxels(const DagView& dag, const VoxelBounds& box, const Vec3& towards, int up,
                    double fov, double aspect) {
  Framing framing(box, towards, up, fov, aspect);
  const Vec3 size = box.max - box.min;
  const double finest = std::max({size[0], size[1], size[2]}) / kFramingCubes;
  if (!dag.empty()) {
    add_cubes(dag, 0, 0, {}, {box, finest}, &framing);
  } else {
    for (const Vec3& corner : corners_of(box)) framing.add(corner, 0);
  }
  return framing.camera();
}

VoxelBounds framing_bounds(const DagView& dag, VoxelBounds box) {
  if (!dag.empty()) grow(dag, 0, 0, {}, &box);
  return box;
}

}  // namespace svdag
