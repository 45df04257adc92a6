// The exact signs behind the filter: one template, two widths.
//
// Bits for |q| < 2^41 and x in the grid (0 <= x <= 2^39): edges 42, n 84 (twice the area of a
// triangle in a square of side 2^42), x - v < 2^41.33, so n.(x - v) < 3 * 2^125.33 < 2^127:
// __int128 suffices with no bit to spare. Up to |q| < 2^62 + 2^61 + 2^33 (io/lattice.h: edges 63,
// n 126, x - v 63, sum 191 bits) 256-bit integers serve.
#pragma once

#include "builder/overlap/triangle_setup.h"

namespace svdag {

constexpr int64_t kNarrowLimit = int64_t(1) << 41;

// Sign (-1, 0, 1) of n . (x - v0).
int exact_plane_sign(const TriangleSetup& t, const LatticePoint& x) noexcept;
// Sign (-1, 0, 1) of edge function k at x.
int exact_edge_sign(const TriangleSetup& t, int k, const LatticePoint& x) noexcept;
// The normal's components, rounded once to double; `sign` gets their exact signs, *dominant the
// (first) axis whose component is largest in magnitude, exactly. `extent` is the largest side of
// the bounding box.
void exact_normal(const LatticeTriangle& t, double extent, bool wide, double normal[3], int sign[3],
                  int* dominant) noexcept;
// The normal of a triangle that is not wide.
void narrow_normal(const LatticeTriangle& t, __int128 n[3]) noexcept;

// The 256-bit versions, in a file of their own for their heavy header.
namespace wide {
int plane_sign(const TriangleSetup& t, const LatticePoint& x) noexcept;
int edge_sign(const TriangleSetup& t, int k, const LatticePoint& x) noexcept;
void normal(const LatticeTriangle& t, double normal[3], int sign[3], int* dominant) noexcept;
}  // namespace wide

}  // namespace svdag
