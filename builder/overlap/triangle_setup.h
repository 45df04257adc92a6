// A snapped triangle, prepared for the overlap tests.
//
// After Schwarz and Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs" (2010), made
// exact: the closed triangle meets a closed cube iff none of these separates them (separating axis
// theorem):
//   box      the three box axes,
//   plane    the triangle's plane: n . (x - v0) must not have one strict sign on the cube,
//   edges    per projection along w = x, y, z with n_w != 0 and per edge e of the triangle: the
//            projected square of the cube must reach the inner side, f >= 0, of the edge.
//
// Notation: edge e runs from vertex from[e] to to[e], d = to - from. In the projection along w with
// the other axes u = w+1, v = w+2 (cyclic): f(x) = sign(n_w) * (d_u (x_v - a_v) - d_v (x_u - a_u)),
// a = vertex from[e]. Edge functions are numbered k = 3w + e; a 9-bit mask (EdgeMask) holds the
// undecided ones.
//
// A projection with n_w = 0 has its edge functions off: they are parallel to the plane's normal, so
// the plane test covers them. A triangle of zero area is a segment (a "polygon" with the two edges
// a->b and b->a, all projections on, plane trivially met) or a point (only the box test).
//
// Functions are scaled so that the magnitudes of their coefficients add up to 1: over a cube of
// side D each of them varies by D, so one error bound holds for all.
//
// Every value is first computed in double with an error bound; only an unsure sign that decides a
// voxel is computed exactly (builder/overlap/exact.h). Rejected: integers everywhere (1.4x slower),
// epsilons (wrong).
//
// Covering: where the three edge functions of the dominant axis w (exactly largest |n_w|) hold in
// a whole cube, the triangle contains all of its plane in the cube's column along w. Inside the
// cube triangle and plane are then the same, and all nine edge functions can be switched off.
#pragma once

#include <cstdint>

#include "io/triangle.h"

namespace svdag {

using EdgeMask = uint16_t;

struct TriangleSetup {
  double vertex[3][4];  // [axis][e]: start of edge e, [3] is 0; exact unless wide
  double normal[3];     // n, exact in integers, rounded and divided by |n|_1
  double edge_u[10];    // coefficients of f: edge_u * (x_u - a_u) + edge_v * (x_v - a_v),
  double edge_v[10];    // divided by the sum of their magnitudes (both 0 if the edge is a point);
                        // a tenth, so that vectors of four begin at each projection's first
  double extent;        // largest side of the bounding box
  LatticeBox box;       // bounding box
  EdgeMask edges;       // edge functions that this triangle has
  EdgeMask cover;       // those of the dominant axis; 0 for a triangle of zero area
  uint8_t dominant;     // the axis w of largest |n_w|
  bool wide;            // some |q| >= 2^41: exact tests need 256-bit integers
  uint8_t from[3], to[3];
  LatticeTriangle triangle;
};

// Requires |q| < 2^62 + 2^61 + 2^33 on every axis and vertices that differ by less than 2^63; the
// snap and BinReader (builder/split/triangle_bins.cpp) check both.
TriangleSetup make_setup(const LatticeTriangle& triangle) noexcept;

// Bound, in lattice units, on the error of a function evaluated in double in a cube that meets the
// triangle's box. `reach` is at least the largest distance of a point from the cube's corner plus
// the cube's side. Derivation: triangle_setup.cpp.
inline double filter_error(const TriangleSetup& t, double reach) noexcept {
  return 16 * 0x1p-53 * (t.extent + reach);
}

// The edge functions still needed where only those of `edges` are undecided.
inline EdgeMask needed_edges(const TriangleSetup& t, EdgeMask edges) noexcept {
  return t.cover != 0 && (edges & t.cover) == 0 ? EdgeMask(0) : edges;
}
// Whether the triangle covers a cube in which only `edges` are undecided.
inline bool covers(const TriangleSetup& t, EdgeMask edges) noexcept {
  return t.cover != 0 && edges == 0;
}

}  // namespace svdag
