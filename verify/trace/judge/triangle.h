// One triangle against a ray or a point, in double: the answer where Embree's floats leave doubt.
//
// Coordinates are voxels. A lattice coordinate below 2^53 steps is exact in them, so the triangle
// is the snapped one itself. The ray is first moved along itself to where it passes the triangle,
// so what cancels is of the size of the triangle, and the errors are a few 2^-52 of the distance.
#pragma once

#include "io/triangle.h"
#include "verify/trace/kernel/vector.h"

namespace svdag {

struct VoxelTriangle {
  Vec3 v[3];
};

VoxelTriangle in_voxels(const LatticeTriangle& triangle, int fraction);

// Where a ray crosses the plane of a triangle.
struct Crossing {
  bool found = false;  // false: the ray is parallel to it, or the triangle has no area
  double t = 0;        // in lengths of the ray's direction
  double inside = 0;  // voxels from the ray to the line of the nearest edge; < 0: it passes outside
  double cosine = 0;  // of the angle between ray and normal, > 0
};
Crossing cross_plane(const Ray& ray, const VoxelTriangle& triangle);

// From a point to the closed triangle, which may be a segment or a point.
double distance(const Vec3& point, const VoxelTriangle& triangle);

// The ray nearest to `ray` that floats relative to `middle` hold; its direction has length 1,
// nearly.
Ray float_ray(const Ray& ray, const Vec3& middle);

}  // namespace svdag
