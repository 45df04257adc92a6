#include "verify/trace/shade.h"

#include <algorithm>
#include <cmath>

namespace svdag {
namespace {

const Vec3 kSun{{1.15, 1.06, 0.92}};
const Vec3 kSky{{0.42, 0.50, 0.62}};
const Vec3 kGround{{0.24, 0.21, 0.19}};

// A light grey, a little darker downwards.
Vec3 background(const Shading& shading, const Vec3& direction) {
  const double h = 0.5 + 0.5 * dot(direction, shading.up);
  return Vec3{{0.62, 0.66, 0.71}} * (1 - h) + Vec3{{0.86, 0.89, 0.93}} * h;
}

// Lambert shading by a sun, of which the part `visibility` is visible, and by a sky that is bright
// above and dim below.
Vec3 lit(const Shading& shading, const Surfel& surfel, double visibility, const Vec3& albedo) {
  const Vec3 to_light = normalized(shading.light.centre - surfel.point);
  const double sun = visibility * std::max(0.0, dot(surfel.normal, to_light));
  const double sky = 0.5 + 0.5 * dot(surfel.normal, shading.up);
  const Vec3 light = kSun * sun + kSky * sky + kGround * (1 - sky);
  return {{albedo[0] * light[0], albedo[1] * light[1], albedo[2] * light[2]}};
}

// Interpolates between evenly spaced colours at v = 0 .. 1.
template <size_t n>
Vec3 ramp(const Vec3 (&stops)[n], double v) {
  const double at = std::clamp(v, 0.0, 1.0) * double(n - 1);
  const size_t i = std::min(size_t(at), n - 2);
  return stops[i] * (double(i) + 1 - at) + stops[i + 1] * (at - double(i));
}

// The colours of a glowing black body.
Vec3 heat(double v) {
  const Vec3 stops[] = {{{0, 0, 0}},   {{0.35, 0, 0.1}}, {{0.8, 0.1, 0}},
                        {{1, 0.6, 0}}, {{1, 0.95, 0.4}}, {{1, 1, 1}}};
  return ramp(stops, v);
}

// From blue for the coarsest level to red for voxels; darker where the surface is visibility at an
// angle.
Vec3 level_colour(const Shading& shading, const Ray& ray, const Hit& hit, const Surfel& surfel) {
  const Vec3 stops[] = {{{0.19, 0.07, 0.55}}, {{0.13, 0.4, 0.85}},  {{0.1, 0.7, 0.6}},
                        {{0.55, 0.8, 0.2}},   {{0.98, 0.75, 0.15}}, {{0.85, 0.15, 0.1}}};
  constexpr double kShown = 10;  // levels above the voxels with different colours
  const double facing = std::abs(dot(surfel.normal, ray.direction));
  const double below = double(shading.levels - hit.level);
  return ramp(stops, 1 - below / kShown) * (0.55 + 0.45 * facing);
}

// A light as far from the camera as half of the empty space above it.
Light lamp(const DagView& dag, const Camera& camera, const Vec3& up, double max_distance) {
  const Vec3 towards = normalized(up * 0.8 + camera.right * -0.5 + camera.forward * 0.3);
  const Hit ceiling = trace_closest(dag, {camera.position, towards}, {0, max_distance});
  const double distance = 0.5 * (ceiling.found ? ceiling.t : max_distance);
  return {camera.position + towards * distance, 0.1 * distance};
}

// Width of the side of the cube that was hit, in pixels; 0 if no width is known.
double pixels_across(const Shading& shading, const Hit& hit) {
  if (shading.pixel == 0) return 0;
  return double(1U << (shading.levels - hit.level)) / std::max(shading.pixel * hit.t, 1e-9);
}

}  // namespace

Shading make_shading(ShadeMode mode, const DagView& dag, const Camera& camera, int up,
                     const VoxelBounds& box) {
  Shading shading;
  shading.mode = mode;
  shading.up[up] = 1;
  Vec3 nearest{};  // point of the box; usually inside a face, nearer than every corner
  for (int a = 0; a < 3; ++a) nearest[a] = std::clamp(camera.position[a], box.min[a], box.max[a]);
  shading.near = length(nearest - camera.position);
  shading.far = 0;
  for (const Vec3& corner : corners_of(box))
    shading.far = std::max(shading.far, length(corner - camera.position));
  const Vec3 towards = normalized(camera.forward * -0.55 + camera.right * -0.6 + shading.up * 0.75);
  const double distance = 2 * length(box.max - box.min);
  shading.light = {(box.min + box.max) * 0.5 + towards * distance, 0.05 * distance};
  shading.levels = dag.levels;
  if (!dag.empty() &&
      trace_any(dag, {camera.position, shading.light.centre - camera.position}, {0, 1}))
    shading.light = lamp(dag, camera, shading.up, 0.25 * distance);
  return shading;
}

Vec3 shown_normal(const Shading& shading, const Ray& ray, const Hit& hit, const Vec3& smooth) {
  constexpr double kSmooth = 4, kFlat = 8;  // pixels across a voxel
  const double flat =
      std::clamp((pixels_across(shading, hit) - kSmooth) / (kFlat - kSmooth), 0.0, 1.0);
  const Vec3 face = face_normal(hit, ray.direction);
  if (flat == 0) return smooth;
  if (dot(face, smooth) < 0) return face;
  return normalized(face * flat + smooth * (1 - flat));
}

double grid_line(const Shading& shading, const Ray& ray, const Hit& hit) {
  constexpr double kDark = 0.55, kMinPixels = 6, kAllPixels = 16;  // lines fade in between
  if (!shading.grid_lines || !hit.found) return 1;
  const double shown =
      std::min(1.0, (pixels_across(shading, hit) - kMinPixels) / (kAllPixels - kMinPixels));
  if (shown <= 0) return 1;
  const double side = double(1U << (shading.levels - hit.level));
  const Vec3 point = ray.origin + ray.direction * hit.t;
  double edge = side;  // distance to the nearest edge of the face
  for (int a = 0; a < 3; ++a) {
    if (a == hit.axis) continue;
    const double at = point[a] / side - std::floor(point[a] / side);
    edge = std::min(edge, side * std::min(at, 1 - at));
  }
  const double pixels = edge / (shading.pixel * hit.t);
  return pixels < 0.5 ? 1 - (1 - kDark) * shown : 1;
}

Vec3 section_colour(const Shading& shading, const Surfel& surfel) {
  const Vec3 red{{0.62, 0.13, 0.09}};
  const double facing = 0.85 + 0.15 * dot(surfel.normal, shading.up);
  return red * facing;
}

Vec3 shade(const Shading& shading, const Ray& ray, const Hit& hit, const Surfel& surfel,
           double visibility, const Vec3& albedo) {
  if (shading.mode == ShadeMode::kSteps) return heat(double(hit.steps) / shading.max_steps);
  if (!hit.found)
    return shading.mode == ShadeMode::kDepth ? Vec3{} : background(shading, ray.direction);
  switch (shading.mode) {
    case ShadeMode::kDepth: {
      const double far = std::max(shading.far - shading.near, 1e-9);
      const double grey = 1 - std::clamp((hit.t - shading.near) / far, 0.0, 1.0);
      return {{grey, grey, grey}};
    }
    case ShadeMode::kNormal:
      return surfel.normal * 0.5 + Vec3{{0.5, 0.5, 0.5}};
    case ShadeMode::kLevel:
      return level_colour(shading, ray, hit, surfel);
    case ShadeMode::kAo:
      return Vec3{{0.85, 0.85, 0.85}} * visibility;
    default:
      return lit(shading, surfel, visibility, albedo);
  }
}

}  // namespace svdag
