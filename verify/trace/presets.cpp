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

// Distance from `from` to the nearest voxel in a direction of length 1, or to the end of the box.
double free_distance(const DagView& dag, const VoxelBounds& box, const Vec3& from,
                     const Vec3& direction) {
  double end = 1e300;
  for (int a = 0; a < 3; ++a) {
    if (direction[a] == 0) continue;
    const double side = direction[a] > 0 ? box.max[a] : box.min[a];
    end = std::min(end, (side - from[a]) / direction[a]);
  }
  const Hit wall = trace_closest(dag, {from, direction}, {0, end});
  return wall.found ? wall.t : end;
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

struct InsidePoint {
  Vec3 point{};
  Vec3 view{};       // horizontal direction of the longest view
  double score = 0;  // 0: not in empty space
};

// Prefers points that are enclosed by voxels, with space around them and a floor below.
InsidePoint score_point(const DagView& dag, const VoxelBounds& box, int up, const Vec3& point,
                        const std::vector<Vec3>& directions) {
  constexpr int kViews = 16;
  constexpr double kClearance = 2;  // voxels
  constexpr double kAmple = 0.1;    // median view, of the size of the box
  const Vec3 size = box.max - box.min;
  const int x = (up + 1) % 3, y = (up + 2) % 3;
  InsidePoint scored{point};
  int blocked = 0;
  for (const Vec3& direction : directions) {
    const Hit wall = trace_closest(dag, {point, direction});
    if (wall.found && wall.t < kClearance) return scored;
    blocked += wall.found;
  }
  std::vector<double> views;
  for (int i = 0; i < kViews; ++i) {
    const double angle = 2 * kPi * i / kViews;
    Vec3 view{};
    view[x] = std::cos(angle);
    view[y] = std::sin(angle);
    views.push_back(free_distance(dag, box, point, view));
    if (views.back() == *std::max_element(views.begin(), views.end())) scored.view = view;
  }
  std::nth_element(views.begin(), views.begin() + kViews / 2, views.end());
  const double space = std::min(1.0, views[kViews / 2] / (kAmple * std::max(size[x], size[y])));
  Vec3 down{};
  down[up] = -1;
  const double floor = trace_any(dag, {point, down}) ? 1 : 0.3;
  const double enclosed = double(blocked) / double(directions.size());
  scored.score = floor * enclosed * enclosed * space;
  return scored;
}

// From the best of 196 points, some way back from its longest view.
Camera inside_view(const DagView& dag, const VoxelBounds& box, int up, double aspect) {
  constexpr double kWide = 75, kBack = 0.6;
  constexpr double kHeights[] = {0.3, 0.15, 0.5, 0.75},
                   kPositions[] = {0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8};
  const std::vector<Vec3> directions = sphere_directions(64);
  const Vec3 size = box.max - box.min;
  InsidePoint best{(box.min + box.max) * 0.5};
  best.view[(up + 1) % 3] = 1;
  for (const double height : kHeights) {
    for (const double x : kPositions) {
      for (const double y : kPositions) {
        Vec3 point = box.min;
        point[up] += height * size[up];
        point[(up + 1) % 3] += x * size[(up + 1) % 3];
        point[(up + 2) % 3] += y * size[(up + 2) % 3];
        const InsidePoint scored = score_point(dag, box, up, point, directions);
        if (scored.score > best.score) best = scored;
      }
    }
  }
  const double back = kBack * free_distance(dag, box, best.point, best.view * -1);
  return look_at(best.point - best.view * back, best.point + best.view, up, kWide, aspect);
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
