// The part of a triangle near a window, in double, for a judge that works in windows.
//
// Coordinates become voxels of the window, voxel centres on the integers. A triangle that reaches
// far out of the window is cut by the six planes some voxels around it (Sutherland and Hodgman
// 1974), or a wall of a 64K^3 grid would cost its judge billions of voxels. Cutting moves points by
// rounding only: a point of the result is within 2^-48 X of the triangle, and vice versa inside the
// window, X being the largest coordinate of the triangle. The border that the cut adds is
// kCutMargin voxels away from the window, farther than any query.
#pragma once

#include <vector>

#include "io/grid.h"

namespace svdag {

constexpr int64_t kCutMargin = 4;

// The part of a convex polygon in the closed box; it may be a segment or a point, or empty.
using Polygon = std::vector<Point>;
Polygon cut_to_box(Polygon polygon, const Point& low, const Point& high);

// Whether the triangle's box meets the window and a voxel around it: else it is nearer than a voxel
// to no centre in the window.
bool is_near(const LatticeTriangle& triangle, const VoxelBox& window, int fraction);

// Appends the triangle, whole or cut; *reach grows to the largest coordinate before the cut.
void append_near_part(const LatticeTriangle& triangle, const VoxelBox& window, int fraction,
                      std::vector<Triangle>* out, double* reach);

}  // namespace svdag
