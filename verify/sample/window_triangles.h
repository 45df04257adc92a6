// Clips triangles to the surroundings of a window, in double, for a judge that works in windows.
//
// Coordinates are in voxels relative to the window, with voxel centres on the integers. A triangle
// that extends far beyond the window is cut by six planes some voxels around it (Sutherland and
// Hodgman 1974); otherwise a wall of a 64K^3 grid would cost its judge billions of voxels. Cutting
// moves points by rounding only: a point of the result is within 2^-48 X of the triangle, and vice
// versa inside the window, X being the largest coordinate of the triangle. The edges that the cut
// adds are kWindowMargin voxels away from the window, farther than any query.
#pragma once

#include <vector>

#include "io/grid.h"

namespace svdag {

constexpr int64_t kWindowMargin = 4;

// The part of a convex polygon in the closed box; may be a segment, a point, or empty.
using Polygon = std::vector<Point>;
Polygon cut_to_box(Polygon polygon, const Point& low, const Point& high);

// True if the triangle's box meets the window enlarged by one voxel. Otherwise the triangle is at
// least a voxel away from every centre in the window.
bool is_near(const LatticeTriangle& triangle, const VoxelBox& window, int fraction);

// Appends the triangle, whole or cut, to *out; raises *reach to its largest coordinate before the
// cut.
void append_near_part(const LatticeTriangle& triangle, const VoxelBox& window, int fraction,
                      std::vector<Triangle>* out, double* reach);

}  // namespace svdag
