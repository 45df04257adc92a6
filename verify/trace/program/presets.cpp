#include "verify/trace/program/presets.h"

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

double free_distance(const DagView& dag, const Vec3& from, int axis, double sign, double most) {
  Vec3 direction{};
  direction[axis] = sign;
  const Hit wall = trace_closest(dag, {from, direction}, {0, most});
  return wall.found ? wall.t : most;
}

// From a spot back along the longer horizontal axis, as far as nothing is in the way. The spot is
// the middle, or, where that has no view (a small room, solid matter), the one of a few that has
// the longest.
Camera inside_view(const DagView& dag, const VoxelBounds& box, int up, double aspect) {
  constexpr double kWide = 75, kFarthest = 0.4, kEnough = 0.25;
  constexpr double kHeights[] = {0.3, 0.15, 0.5, 0.75},
                   kPlaces[] = {0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8};
  const Vec3 size = box.max - box.min;
  const int one = (up + 1) % 3, two = (up + 2) % 3;
  const int along = size[one] > size[two] ? one : two, across = one + two - along;
  const double farthest = kFarthest * size[along];
  Vec3 best{};
  double longest = -1;
  for (const double height : kHeights) {
    for (const double place : kPlaces) {
      for (const double side : kPlaces) {
        Vec3 spot = box.min;
        spot[up] += height * size[up];
        spot[along] += place * size[along];
        spot[across] += side * size[across];
        const double view = free_distance(dag, spot, along, 1, farthest) +
                            free_distance(dag, spot, along, -1, farthest);
        if (longest < kEnough * size[along] && view > longest) {
          longest = view;
          best = spot;
        }
      }
    }
  }
  Vec3 back{};
  back[along] = -1;
  const double far = 0.95 * free_distance(dag, best, along, -1, farthest);
  return look_at(best + back * far, best - back * size[along], up, kWide, aspect);
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
