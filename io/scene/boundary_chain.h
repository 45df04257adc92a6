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
// not, except with a probability of 2^-128 a scene. Edges of zero length add nothing, and neither
// do the edges of a triangle of zero area, together. Modulo 2, directions do not matter.
//
// Most closed scenes have no T-junctions, and primitive directions take a greatest common divisor
// for each edge. EdgeSum is cheaper: each directed edge adds or takes away the hash of its two
// ends, so it vanishes if edges match each other one by one. The chain decides only where it does
// not.
// Rejected: a table of all edges (the largest scenes do not fit), and a fixed key (a scene could be
// made to look closed).
// Rejected as well: normal forms of lines modulo a prime instead of primitive directions (a
// scene could be made to look closed).
#pragma once

#include <array>
#include <cstdint>

#include "io/triangle.h"

namespace svdag {

// A sum of 128-bit hashes, and their sum modulo 2.
class HashSum {
 public:
  using Hash = std::array<uint64_t, 2>;

  void add(const Hash& hash, bool positive) {
    for (size_t i = 0; i < 2; ++i) {
      sum_[i] += positive ? hash[i] : -hash[i];
      parity_[i] ^= hash[i];
    }
  }
  bool is_zero() const { return sum_ == Hash{}; }
  bool is_zero_mod_2() const { return parity_ == Hash{}; }

 private:
  Hash sum_{}, parity_{};
};

// The hash of two points, with the key of this process.
HashSum::Hash hash_of_points(const LatticePoint& a, const LatticePoint& b) noexcept;

class EdgeSum {
 public:
  void add(const LatticeTriangle& triangle);
  // Whether the edges match one by one: then the surface is closed.
  bool is_closed() const { return sum_.is_zero(); }
  bool is_closed_mod_2() const { return sum_.is_zero_mod_2(); }

 private:
  HashSum sum_;
};

class BoundaryChain {
 public:
  // The end of an edge: it adds `sum` if the edge ends there, else takes it away.
  struct EdgeEnd {
    LatticePoint point;
    HashSum::Hash hash;
    bool adds;
  };

  void add(const LatticeTriangle& triangle) {
    for_each_end(triangle, [&](const EdgeEnd& end) { add(end); });
  }
  void add(const EdgeEnd& end) { sum_.add(end.hash, end.adds); }
  bool is_closed() const { return sum_.is_zero(); }
  // Closed if every edge may be passed in either direction.
  bool is_closed_mod_2() const { return sum_.is_zero_mod_2(); }

  // Calls visit(end) for the two ends of each edge that has a length.
  template <class Visit>
  static void for_each_end(const LatticeTriangle& triangle, const Visit& visit) {
    for (size_t i = 0; i < 3; ++i) {
      const LatticePoint &a = triangle.v[i], &b = triangle.v[(i + 1) % 3];
      if (a == b) continue;
      const LatticePoint d = primitive_direction(a, b);
      visit(EdgeEnd{b, hash_of_points(d, b), true});
      visit(EdgeEnd{a, hash_of_points(d, a), false});
    }
  }

 private:
  // With its first nonzero component positive, the same for both directions of an edge.
  static LatticePoint primitive_direction(const LatticePoint& a, const LatticePoint& b) noexcept;

  HashSum sum_;
};

}  // namespace svdag
