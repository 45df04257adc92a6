#include "verify/trace/program/presets.h"

#include <cmath>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr double kPi = 3.14159265358979323846;

bool contains(const VoxelBounds& box, const Vec3& point) {
  bool inside = true;
  for (int a = 0; a < 3; ++a) inside = inside && point[a] >= box.min[a] && point[a] <= box.max[a];
  return inside;
}

// Distance from a point along an axis to the nearest voxel, at most `max`.
double free_distance(const DagView& dag, const Vec3& from, int axis, double sign, double max) {
  Vec3 direction{};
  direction[axis] = sign;
  const Hit wall = trace_closest(dag, {from, direction}, {0, max});
  return wall.found ? wall.t : max;
}

// Looks along the longer horizontal axis, from a point as far back as empty space reaches. The view
// goes through the middle of the box. If the view there is short (a small room, solid matter), it
// goes through that of several candidate points with the longest view.
Camera inside_view(const DagView& dag, const VoxelBounds& box, int up, double aspect) {
  constexpr double kWide = 75, kMaxBack = 0.4, kLongEnough = 0.25;
  constexpr double kHeights[] = {0.3, 0.15, 0.5, 0.75},
                   kPositions[] = {0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8};
  const Vec3 size = box.max - box.min;
  const int one = (up + 1) % 3, two = (up + 2) % 3;
  const int along = size[one] > size[two] ? one : two, across = one + two - along;
  const double max_distance = kMaxBack * size[along];
  Vec3 best{};
  double longest = -1;
  for (const double height : kHeights) {
    for (const double depth : kPositions) {
      for (const double side : kPositions) {
        Vec3 point = box.min;
        point[up] += height * size[up];
        point[along] += depth * size[along];
        point[across] += side * size[across];
        const double view = free_distance(dag, point, along, 1, max_distance) +
                            free_distance(dag, point, along, -1, max_distance);
        if (longest < kLongEnough * size[along] && view > longest) {
          longest = view;
          best = point;
        }
      }
    }
  }
  Vec3 back{};
  back[along] = -1;
  const double far = 0.95 * free_distance(dag, best, along, -1, max_distance);
  return look_at(best + back * far, best - back * size[along], up, kWide, aspect);
}

}  // namespace

Camera preset_camera(const std::string& name, const DagView& dag, const VoxelBounds& box, int up,
                     double fov, double aspect) {
  if (name == "inside") return inside_view(dag, box, up, aspect);
  Vec3 towards{};  // from the box to the camera
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
  if (contains(box, camera.position)) return result;
  const Vec3 centre = (box.min + box.max) * 0.5;
  result.position = centre + turn(camera.position - centre);
  return result;
}

}  // namespace svdag
