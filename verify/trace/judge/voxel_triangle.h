// Intersects one triangle with a ray or a point in double, to recheck Embree's floats.
//
// Coordinates are in voxels. Lattice coordinates below 2^53 steps are exact in double, so the
// triangle is the snapped one itself. The ray's origin is first moved along the ray to the
// triangle, so that cancelling terms have the size of the triangle; errors are a few 2^-52 of the
// distance.
#pragma once

#include "io/scene/cutouts/cut_out.h"
#include "io/triangle.h"
#include "verify/trace/kernel/vector.h"

namespace svdag {

struct VoxelTriangle {
  Vec3 v[3];
};

VoxelTriangle in_voxels(const LatticeTriangle& triangle, int fraction);

// The point where a ray crosses the plane of a triangle.
struct Crossing {
  bool found = false;  // false: the ray is parallel to it, or the triangle has no area
  double t = 0;        // in lengths of the ray's direction
  double inside = 0;   // voxels from the ray to the line of the nearest edge; < 0: outside
  double cosine = 0;   // of the angle between ray and normal, > 0
};
Crossing cross_plane(const Ray& ray, const VoxelTriangle& triangle);

// Whether the point of the plane of a cut-out triangle, and all points within `doubt` voxels of it,
// are opaque. A triangle without area has no such point.
bool is_surely_opaque(const CutOut& cut, const TextureCorners& texture,
                      const VoxelTriangle& triangle, const Vec3& point, double doubt);

// Distance from a point to the closed triangle, which may be a segment or a point.
double distance(const Vec3& point, const VoxelTriangle& triangle);

// `ray` rounded to floats relative to `middle`. The direction has length 1, up to rounding.
Ray float_ray(const Ray& ray, const Vec3& middle);

}  // namespace svdag
