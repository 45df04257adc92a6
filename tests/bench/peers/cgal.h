// CGAL's do_intersect(triangle, box) with two kernels, in a separate library because CGAL's
// target adds -frounding-math to everything that links it.
//   EPICK  double coordinates, filtered exact predicates, constructions in double
//   EPECK  lazy exact numbers throughout
// A triangle of zero area violates do_intersect's precondition: it is passed as a segment or a
// point. Coordinates are doubles in voxel units.
#pragma once

#include <span>
#include <vector>

#include "io/grid.h"
#include "tests/bench/peers/cube_descent.h"

namespace svdag::bench {

void cgal_epick(const Grid& grid, std::span<const Triangle> triangles, const LatticePoint& corner,
                int log2, BrickList* out);
void cgal_epeck(const Grid& grid, std::span<const Triangle> triangles, const LatticePoint& corner,
                int log2, BrickList* out);

}  // namespace svdag::bench
