// Exact signs of the separating functions, for the values that the floating-point filter leaves
// unsure: one template, two integer widths.
//
// Bits for |q| < 2^41 and x in the grid (0 <= x <= 2^39): edges 42, n 84 (twice the area of a
// triangle in a square of side 2^42), x - v < 2^41.33, so n.(x - v) < 3 * 2^125.33 < 2^127:
// __int128 suffices with no bit to spare. Beyond, up to |q| < 2^62 + 2^61 + 2^33 (io/lattice.h;
// edges 63, n 126, x - v 63, sum 191 bits), 256-bit integers are used.
#pragma once

#include "builder/overlap/triangle_setup.h"

namespace svdag {

constexpr int64_t kNarrowLimit = int64_t(1) << 41;

// Sign (-1, 0, 1) of n . (x - v0).
int exact_plane_sign(const TriangleSetup& t, const LatticePoint& x) noexcept;
// Sign (-1, 0, 1) of edge function k at x.
int exact_edge_sign(const TriangleSetup& t, int k, const LatticePoint& x) noexcept;
// Computes the components of the normal, each rounded once to double, their exact signs, and in
// *dominant the first axis whose exact component is largest in magnitude. `extent` is the largest
// side of the bounding box.
void exact_normal(const LatticeTriangle& t, double extent, bool wide, double normal[3], int sign[3],
                  int* dominant) noexcept;
// The exact normal of a triangle that is not wide.
void narrow_normal(const LatticeTriangle& t, __int128 n[3]) noexcept;

// The 256-bit versions, in a separate file because of their heavy header.
namespace wide {
int plane_sign(const TriangleSetup& t, const LatticePoint& x) noexcept;
int edge_sign(const TriangleSetup& t, int k, const LatticePoint& x) noexcept;
void normal(const LatticeTriangle& t, double normal[3], int sign[3], int* dominant) noexcept;
}  // namespace wide

}  // namespace svdag
