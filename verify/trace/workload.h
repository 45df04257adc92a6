// The rays of the measured workloads, one by one, for host and CUDA.
//
//   primary   a closest hit per pixel
//   shadow    from what a pixel shows to a point light
//   soft      the same to `samples` points of a ball that shines
//   ao        ambient occlusion: `samples` cosine-weighted rays of at most `reach` voxels
//
// Rays are functions of (pixel, number), so the same ones can be given to another tracer. Rays from
// a surface start kLift voxels above it along its normal: a sheet of voxels is up to sqrt(3) thick,
// and must not shade itself.
#pragma once

#include "verify/trace/camera.h"
#include "verify/trace/sampling.h"
#include "verify/trace/surface.h"

namespace svdag {

constexpr double kLift = 2.5;

// What a pixel shows, and where its secondary rays start.
struct Surfel {
  bool found = false;
  Vec3 point{};
  Vec3 normal{};
};

struct Light {
  Vec3 centre{};      // in voxels
  double radius = 0;  // in voxels; 0: a point
};

struct Secondary {
  uint32_t samples = 64;  // rays per pixel
  double reach = 1e300;   // ambient occlusion: of a ray, in voxels
  Cut cut;                // of secondary rays; none by default, so that answers are exact
};

struct Picture {
  Camera camera;
  uint32_t width, height;
  // Through the middle of pixel (x, y), from the upper left.
  SVDAG_HD Ray ray(uint32_t x, uint32_t y) const {
    return camera.ray((x + 0.5) / width, (y + 0.5) / height);
  }
};

SVDAG_HD inline Surfel make_surfel(const DagView& dag, const Ray& ray, const Hit& hit) {
  Surfel surfel;
  surfel.found = hit.found;
  if (!hit.found) return surfel;
  surfel.normal = surface_normal(dag, hit, ray.direction);
  surfel.point = ray.origin + ray.direction * hit.t + surfel.normal * kLift;
  return surfel;
}

// From the surface (t = 0) to the light's centre (t = 1).
SVDAG_HD inline Ray shadow_ray(const Surfel& surfel, const Light& light) {
  return {surfel.point, light.centre - surfel.point};
}

// From the surface (t = 0) to the light's i-th of n points (t = 1).
SVDAG_HD inline Ray soft_ray(const Surfel& surfel, const Light& light, uint64_t pixel, uint32_t i,
                             uint32_t n) {
  const Point2 square = square_point(pixel, i, n);
  return {surfel.point,
          light_point(light.centre, light.radius, surfel.point, square) - surfel.point};
}

// The i-th of n directions, of length 1.
SVDAG_HD inline Ray occlusion_ray(const Surfel& surfel, uint64_t pixel, uint32_t i, uint32_t n) {
  return {surfel.point, cosine_direction(surfel.normal, square_point(pixel, i, n))};
}

SVDAG_HD inline bool shadowed(const DagView& dag, const Surfel& surfel, const Light& light,
                              const Cut& cut = {}) {
  return trace_any(dag, shadow_ray(surfel, light), {0, 1}, cut);
}

// How many of the samples are blocked, of either workload.
SVDAG_HD inline uint32_t soft_blocked(const DagView& dag, const Surfel& surfel, const Light& light,
                                      uint64_t pixel, const Secondary& with) {
  uint32_t blocked = 0;
  for (uint32_t i = 0; i < with.samples; ++i) {
    const Ray ray = soft_ray(surfel, light, pixel, i, with.samples);
    blocked += trace_any(dag, ray, {0, 1}, with.cut);
  }
  return blocked;
}

SVDAG_HD inline uint32_t occlusion_blocked(const DagView& dag, const Surfel& surfel, uint64_t pixel,
                                           const Secondary& with) {
  uint32_t blocked = 0;
  for (uint32_t i = 0; i < with.samples; ++i) {
    const Ray ray = occlusion_ray(surfel, pixel, i, with.samples);
    blocked += trace_any(dag, ray, {0, with.reach}, with.cut);
  }
  return blocked;
}

}  // namespace svdag
