#include "verify/trace/shade.h"

#include <algorithm>

#include "verify/trace/surface.h"

namespace svdag {
namespace {

const Vec3 kClay{{0.50, 0.46, 0.40}};
const Vec3 kSun{{1.15, 1.06, 0.92}};
const Vec3 kSky{{0.42, 0.50, 0.62}};
const Vec3 kGround{{0.24, 0.21, 0.19}};

// Light paper, a little darker downwards.
Vec3 background(const Shading& shading, const Vec3& direction) {
  if (shading.mode == ShadeMode::kDepth) return {};
  const double h = 0.5 + 0.5 * dot(direction, shading.up);
  return Vec3{{0.62, 0.66, 0.71}} * (1 - h) + Vec3{{0.86, 0.89, 0.93}} * h;
}

// Whether something stands between the hit and the light. The ray starts a little off the surface,
// by more than the thickness of a voxelized sheet, so that a wall does not shade itself.
bool in_shadow(const Shading& shading, const DagView& dag, const Ray& ray, const Hit& hit,
               const Vec3& normal) {
  constexpr double kOff = 2.0;  // voxels
  const Vec3 start = ray.origin + ray.direction * hit.t + (normal + shading.light) * kOff;
  return trace_closest(dag, {start, shading.light}).found;
}

// Lambert under one sun and a sky that is bright above and dim below.
Vec3 clay(const Shading& shading, const Vec3& normal, bool lit) {
  const double sun = lit ? std::max(0.0, dot(normal, shading.light)) : 0;
  const double sky = 0.5 + 0.5 * dot(normal, shading.up);
  const Vec3 light = kSun * sun + kSky * sky + kGround * (1 - sky);
  return {{kClay[0] * light[0], kClay[1] * light[1], kClay[2] * light[2]}};
}

}  // namespace

Shading make_shading(ShadeMode mode, const Camera& camera, int up, const VoxelBounds& box) {
  Shading shading;
  shading.mode = mode;
  shading.up[up] = 1;
  shading.light = normalized(camera.forward * -0.55 + camera.right * -0.6 + shading.up * 0.75);
  shading.near = 1e300;
  shading.far = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner{{i & 1 ? box.max[0] : box.min[0], i & 2 ? box.max[1] : box.min[1],
                       i & 4 ? box.max[2] : box.min[2]}};
    const Vec3 d = corner - camera.position;
    const double distance = length(d);
    shading.near = std::min(shading.near, distance);
    shading.far = std::max(shading.far, distance);
  }
  bool inside = true;
  for (int a = 0; a < 3; ++a)
    inside = inside && camera.position[a] >= box.min[a] && camera.position[a] <= box.max[a];
  if (inside) shading.near = 0;
  return shading;
}

Vec3 shade(const Shading& shading, const DagView& dag, const Ray& ray, const Hit& hit) {
  if (!hit.found) return background(shading, ray.direction);
  if (shading.mode == ShadeMode::kDepth) {
    const double far = std::max(shading.far - shading.near, 1e-9);
    const double grey = 1 - std::clamp((hit.t - shading.near) / far, 0.0, 1.0);
    return {{grey, grey, grey}};
  }
  const Vec3 normal = surface_normal(dag, hit, ray.direction);
  if (shading.mode == ShadeMode::kNormal) return normal * 0.5 + Vec3{{0.5, 0.5, 0.5}};
  const bool lit = shading.mode != ShadeMode::kShadow || !in_shadow(shading, dag, ray, hit, normal);
  return clay(shading, normal, lit);
}

}  // namespace svdag
