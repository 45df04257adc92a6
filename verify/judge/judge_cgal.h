// The second judge, on CGAL's exact kernel (EPECK: lazy rationals behind interval filters).
//
// Conservative: do_intersect of the triangle with closed boxes of cells. A box that the triangle
// misses is dropped, any other is halved until it is one cell, so only CGAL prunes. Triangles of
// zero area are passed as segments or points: the precondition of do_intersect excludes triangles
// with equal vertices.
//
// Thin: the symbolic shift d = (e, e^2, e^3) becomes a real one with e = 2^-256. All decisions are
// signs of A + B e + C e^2 + D e^3 with integers below 2^192 (edge functions and plane offsets of
// coordinates below 1.5 * 2^62), so the first nonzero coefficient decides for this e as for every
// smaller one: |B| e + |C| e^2 + |D| e^3 < 1, and so on. do_intersect of the triangle with the
// shifted centre segments is then literally the rule's definition.
//
// Solid: the vertical lines through the centres, shifted in the same way, and do_intersect with the
// triangle; the side of its plane on which a shifted centre is.
//
// Costs 200 .. 400 ns per pair if the filter decides, microseconds otherwise: for samples and small
// grids. The only part of svdag that uses CGAL.
#pragma once

#include <memory>

#include "verify/judge/judge.h"

namespace svdag {

// In a build without CGAL this is an Error (kUsage).
std::unique_ptr<Judge> make_cgal_judge(Rule rule);

}  // namespace svdag
