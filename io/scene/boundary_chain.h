// Whether triangles form closed surfaces: their boundary chain, streamed in constant memory.
//
// A triangle's boundary is its three directed edges; a set of triangles is closed if each point of
// each line is passed as often in one direction as in the other. Then winding numbers are defined
// everywhere. An edge may be matched by several shorter ones (a T-junction that is exactly on it),
// since only the sum counts.
//
// On a line a chain of segments vanishes iff its boundary does, so each directed edge a -> b adds
// H(d, b) - H(d, a), where d is the primitive direction of its line, H a 128-bit hash with a random
// key: a point and a direction determine the line. The sum is 0 for closed surfaces, and otherwise
// not, but for a probability of 2^-128 a scene. Edges of zero length add nothing, and neither do
// the edges of a triangle of zero area, together. Modulo 2, directions do not matter.
// Rejected: a table of all edges (the largest scenes do not fit), and a fixed key (a scene could be
// made to look closed).
#pragma once

#include <array>
#include <cstdint>

#include "io/triangle.h"

namespace svdag {

class BoundaryChain {
 public:
  using Sum = std::array<uint64_t, 2>;
  // The end of an edge: it adds `sum` if the edge ends there, else takes it away.
  struct EdgeEnd {
    LatticePoint point;
    Sum hash;
    bool adds;
  };

  void add(const LatticeTriangle& triangle) {
    for_each_end(triangle, [&](const EdgeEnd& end) { add(end); });
  }
  void add(const EdgeEnd& end) {
    for (size_t i = 0; i < 2; ++i) {
      sum_[i] += end.adds ? end.hash[i] : -end.hash[i];
      parity_[i] ^= end.hash[i];
    }
  }
  bool is_closed() const { return sum_ == Sum{}; }
  // Closed if every edge may be passed in either direction.
  bool is_closed_mod_2() const { return parity_ == Sum{}; }

  // Calls visit(end) for the two ends of each edge that has a length.
  template <class Visit>
  static void for_each_end(const LatticeTriangle& triangle, const Visit& visit) {
    for (size_t i = 0; i < 3; ++i) {
      const LatticePoint &a = triangle.v[i], &b = triangle.v[(i + 1) % 3];
      if (a == b) continue;
      const LatticePoint d = primitive_direction(a, b);
      visit(EdgeEnd{b, hash_of(d, b), true});
      visit(EdgeEnd{a, hash_of(d, a), false});
    }
  }

 private:
  // With its first nonzero component positive, the same for both directions of an edge.
  static LatticePoint primitive_direction(const LatticePoint& a, const LatticePoint& b) noexcept;
  static Sum hash_of(const LatticePoint& direction, const LatticePoint& point) noexcept;

  Sum sum_{}, parity_{};
};

}  // namespace svdag
