// The rays that are traced through both the DAG and its triangles: a fifth of each kind.
//
//   camera    through a picture that frames the scene: what a user sees first
//   chord     between two points on the sphere around the scene: all positions and directions
//   inside    from a point in the scene's box: most start in empty space, some in a voxel
//   axis      along an axis through centres of voxels, half of them near a point of a triangle
//   surface   from a point of a triangle, cosine-distributed on either side: away from it, starting
//             two voxels off, or towards it from further away, which always hits
//
// Ray i depends only on the seed and i, so the rays are the same with any number of threads. All
// are rounded to floats (float_ray), so both sides trace exactly the same ray.
#pragma once

#include "verify/trace/judge/embree.h"
#include "verify/trace/kernel/camera.h"

namespace svdag {

enum class RayKind { kCamera, kChord, kInside, kAxis, kSurface };
constexpr int kRayKinds = 5;
constexpr const char* kRayKindNames[kRayKinds] = {"camera", "chord", "inside", "axis", "surface"};

// SplitMix64 (Steele et al. 2014): good numbers from any seed, so each ray can have its own state.
class RayRandom {
 public:
  RayRandom(uint64_t seed, uint64_t index) : state_(seed * 0x9e3779b97f4a7c15U) {
    state_ = next() ^ index * 0xbf58476d1ce4e5b9U;
  }
  uint64_t next() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
    z = (z ^ z >> 27) * 0x94d049bb133111ebU;
    return z ^ z >> 31;
  }
  // Uniform in [0, 1).
  double unit() { return double(next() >> 11) * 0x1p-53; }

 private:
  uint64_t state_;
};

// Draws points on triangles: half of them by area, half by triangle, so that small ones count too.
class TriangleSampler {
 public:
  struct Sample {
    Vec3 point;
    Vec3 normal;  // unit length; an axis if the triangle has no area
    uint32_t triangle;
  };

  TriangleSampler(std::span<const VoxelTriangle> triangles, MemoryBudget* budget);
  bool empty() const { return areas_.empty(); }
  // Requires !empty().
  Sample draw(RayRandom& random) const;

 private:
  std::span<const VoxelTriangle> triangles_;
  MemoryBudget::Reservation reservation_;
  std::vector<double> areas_;  // [i]: double the area of triangles 0 .. i together
};

class TestRays {
 public:
  // Rays around `box`. The tracer and the sampler must outlive this.
  TestRays(const VoxelBounds& box, const TriangleTracer& tracer, const TriangleSampler& sampler,
           uint64_t seed);

  static RayKind kind(uint64_t index) { return RayKind(index % kRayKinds); }
  Ray ray(uint64_t index) const;

 private:
  Ray chord(RayRandom& random) const;
  Ray inside(RayRandom& random) const;
  Ray along_axis(RayRandom& random) const;
  Ray at_surface(RayRandom& random) const;

  VoxelBounds box_;
  Camera camera_;
  const TriangleTracer& tracer_;
  const TriangleSampler& sampler_;
  uint64_t seed_;
};

}  // namespace svdag
