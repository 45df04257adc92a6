// The second judge: CGAL's exact kernel (EPECK: lazy rationals behind interval filters).
//
// Conservative: do_intersect of the triangle with closed boxes of cells. A box that the triangle
// misses is dropped, any other halved until it is one cell, so nothing but CGAL prunes.
// Triangles of zero area are segments or points: do_intersect is wrong for triangles with equal
// vertices, which its precondition excludes.
//
// Thin: the symbolic move d = (e, e^2, e^3) becomes a real one with e = 2^-256. All decisions are
// signs of A + B e + C e^2 + D e^3 with integers below 2^192 (edge functions and plane offsets of
// coordinates below 1.5 * 2^62), so the first that is not zero decides for this e as for every
// smaller one: |B| e + |C| e^2 + |D| e^3 < 1, and so on. Then do_intersect of the triangle with the
// moved centre segments is the rule's definition, word by word.
//
// 200 .. 400 ns for each pair where the filter decides and microseconds where it does not: for
// samples and small grids. This is the only part of svdag that knows CGAL.
#pragma once

#include <memory>

#include "verify/judge/judge.h"

namespace svdag {

// An Error (kUsage) where svdag was built without CGAL.
std::unique_ptr<Judge> make_cgal_judge(Rule rule);

}  // namespace svdag
