#include "verify/trace/presets.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "streaming/error.h"

namespace svdag {
namespace {

bool contains(const VoxelBounds& box, const Vec3& point) {
  bool inside = true;
  for (int a = 0; a < 3; ++a) inside = inside && point[a] >= box.min[a] && point[a] <= box.max[a];
  return inside;
}

// Unit vectors around a point, evenly spaced (a Fibonacci sphere).
std::vector<Vec3> sphere_directions(int count) {
  std::vector<Vec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), angle = 2.399963 * i;
    directions.push_back({{r * std::cos(angle), r * std::sin(angle), z}});
  }
  return directions;
}

struct InsideView {
  Vec3 point{};
  Vec3 forward{};    // horizontal
  double score = 0;  // 0: not in empty space
};

constexpr double kWideFov = 75;  // degrees

// What a view shows, 0 to 1: how far it goes, unless much of it is close, or it looks down at
// nothing, as from below the ground.
double score_view(const DagView& dag, const Vec3& size, int up, const Vec3& point,
                  const Vec3& forward) {
  constexpr int kAcross = 9, kUpwards = 5;
  constexpr double kFar = 0.4, kNear = 0.06;  // of the larger horizontal side
  constexpr double kSky = 0.15;               // what a ray upwards counts that hits nothing
  const int x = (up + 1) % 3, y = (up + 2) % 3;
  const double side = std::max(size[x], size[y]), slope = std::tan(kWideFov / 2 * kPi / 180);
  Vec3 right{};
  right[x] = forward[y];
  right[y] = -forward[x];
  double depth = 0;
  int bad = 0;
  for (int i = 0; i < kAcross; ++i) {
    for (int j = 0; j < kUpwards; ++j) {
      Vec3 direction = forward + right * (slope * (2 * (i + 0.5) / kAcross - 1));
      direction[up] = 0.6 * slope * (2 * (j + 0.5) / kUpwards - 1);
      const Hit hit = trace_closest(dag, {point, normalized(direction)});
      depth += hit.found ? std::min(1.0, hit.t / (kFar * side)) : kSky;
      bad += hit.found ? hit.t < kNear * side : direction[up] < 0;
    }
  }
  const double rays = kAcross * kUpwards, open = 1 - bad / rays;
  return depth / rays * open * open;
}

// Prefers points that are enclosed by voxels, not far above a floor, and among their views the one
// that shows most.
InsideView best_view(const DagView& dag, const VoxelBounds& box, int up, const Vec3& point,
                     const std::vector<Vec3>& directions) {
  constexpr int kViews = 12;
  constexpr double kClearance = 2;  // voxels
  constexpr double kLow = 0.25;     // above a floor, of the height of the box
  const Vec3 size = box.max - box.min;
  InsideView best{point};
  int blocked = 0;
  for (const Vec3& direction : directions) {
    const Hit wall = trace_closest(dag, {point, direction});
    if (wall.found && wall.t < kClearance) return best;
    blocked += wall.found;
  }
  Vec3 down{};
  down[up] = -1;
  const Hit floor = trace_closest(dag, {point, down});
  const double standing = !floor.found ? 0.1 : floor.t < kLow * size[up] ? 1 : 0.6;
  const double enclosed = double(blocked) / double(directions.size());
  for (int i = 0; i < kViews; ++i) {
    const double angle = 2 * kPi * i / kViews;
    Vec3 forward{};
    forward[(up + 1) % 3] = std::cos(angle);
    forward[(up + 2) % 3] = std::sin(angle);
    const double score = standing * enclosed * enclosed * score_view(dag, size, up, point, forward);
    if (score > best.score) best = {point, forward, score};
  }
  return best;
}

// The best of 196 points.
Camera inside_view(const DagView& dag, const VoxelBounds& box, int up, double aspect) {
  constexpr double kHeights[] = {0.3, 0.15, 0.5, 0.75},
                   kPositions[] = {0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8};
  const std::vector<Vec3> directions = sphere_directions(64);
  const Vec3 size = box.max - box.min;
  InsideView best{(box.min + box.max) * 0.5};
  best.forward[(up + 1) % 3] = 1;
  for (const double height : kHeights) {
    for (const double x : kPositions) {
      for (const double y : kPositions) {
        Vec3 point = box.min;
        point[up] += height * size[up];
        point[(up + 1) % 3] += x * size[(up + 1) % 3];
        point[(up + 2) % 3] += y * size[(up + 2) % 3];
        const InsideView view = best_view(dag, box, up, point, directions);
        if (view.score > best.score) best = view;
      }
    }
  }
  return look_at(best.point, best.point + best.forward, up, kWideFov, aspect);
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
  return frame_voxels(dag, box, towards, up, fov, aspect);
}

VoxelBounds turntable_bounds(VoxelBounds box, int up) {
  const int x = (up + 1) % 3, y = (up + 2) % 3;
  const Vec3 centre = (box.min + box.max) * 0.5;
  const double radius = std::hypot(box.max[x] - centre[x], box.max[y] - centre[y]);
  for (const int a : {x, y}) {
    box.min[a] = centre[a] - radius;
    box.max[a] = centre[a] + radius;
  }
  return box;
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
