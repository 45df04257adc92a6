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

#include "verify/trace/kernel/beam.h"
#include "verify/trace/kernel/sampling.h"
#include "verify/trace/kernel/surface.h"

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

// The span of the rays through the tile whose upper left pixel is (left, top).
SVDAG_HD inline Span tile_span(const DagView& dag, const Picture& picture, uint32_t left,
                               uint32_t top) {
  Beam beam;
  for (uint32_t i = 0; i < kTile * kTile; ++i)
    beam.add(picture.ray(left + i % kTile, top + i / kTile));
  return beam.reach(dag, {}, {}, false);
}

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
  return {surfel.point, towards(surfel.point, light.centre)};
}

// From the surface (t = 0) to the light's i-th of n points (t = 1).
SVDAG_HD inline Ray soft_ray(const Surfel& surfel, const Light& light, uint64_t pixel, uint32_t i,
                             uint32_t n) {
  const Point2 square = square_point(pixel, i, n);
  return {surfel.point,
          towards(surfel.point, light_point(light.centre, light.radius, surfel.point, square))};
}

// The i-th of n directions, of length 1.
SVDAG_HD inline Ray occlusion_ray(const Surfel& surfel, uint64_t pixel, uint32_t i, uint32_t n) {
  return {surfel.point, cosine_direction(surfel.normal, square_point(pixel, i, n))};
}

}  // namespace svdag
