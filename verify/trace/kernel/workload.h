// The rays of the four measured workloads, for host and CUDA.
//
//   primary   a closest hit per pixel
//   shadow    from the surface of a pixel to a point light
//   soft      from there to `samples` points of a spherical light
//   ao        ambient occlusion: `samples` cosine-weighted rays of at most `reach` voxels
//
// Rays are functions of (pixel, number), so another tracer can be given the same rays. Rays from a
// surface start kLift voxels above it along its normal, because a sheet of voxels is up to sqrt(3)
// thick and must not shadow itself.
#pragma once

#include "verify/trace/kernel/beam.h"
#include "verify/trace/kernel/sampling.h"
#include "verify/trace/kernel/surface.h"

namespace svdag {

constexpr double kLift = 2.5;  // voxels

// The surface that a pixel shows; its secondary rays start at `point`.
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
  double reach = 1e300;   // length of ambient occlusion rays, in voxels
  Cut cut;                // none by default, so that results are exact
};

struct Picture {
  Camera camera;
  uint32_t width, height;
  // The ray through the middle of pixel (x, y), counted from the upper left.
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
  surfel.normal = surface_normal(dag, hit, ray);
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
