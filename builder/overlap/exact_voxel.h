// Exact decisions for single voxels and columns of a brick, for values that are unsure in double.
#pragma once

#include "builder/overlap/triangle_setup.h"

namespace svdag {

// Conservative: does the projected closed square of column 4i + j (i on axis w+1, j on axis w+2,
// w = k / 3) of the brick at `corner` reach the inner side of edge function k?
bool column_reaches(const TriangleSetup& t, int k, const LatticePoint& corner, int fraction,
                    unsigned column) noexcept;
// Conservative: does the plane meet the closed voxel `bit` of the brick?
bool voxel_meets_plane(const TriangleSetup& t, const LatticePoint& corner, int fraction,
                       unsigned bit) noexcept;

// Thin: is edge function k positive at the centre of the column, shifted symbolically?
bool column_centre_holds(const TriangleSetup& t, int k, const LatticePoint& corner, int fraction,
                         unsigned column) noexcept;
// Thin: is edge function k, which has an area, positive at x, shifted symbolically?
bool edge_holds_at(const TriangleSetup& t, int k, const LatticePoint& x) noexcept;
// Thin: is n . (x - v0) positive at x, shifted symbolically?
bool is_above_plane(const TriangleSetup& t, const LatticePoint& x) noexcept;
// Thin: the same for the lower or upper end x of the centre segment of voxel `bit` along axis w.
bool end_is_above_plane(const TriangleSetup& t, const LatticePoint& corner, int fraction,
                        unsigned bit, int w, bool upper) noexcept;

}  // namespace svdag
