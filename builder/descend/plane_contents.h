// Contents of small covered cubes: a cache, shared by all planes, of cubes of 8x8x8 voxels.
//
// Planes with different normals often set the same voxels of a small cube, so the plane memo
// (builder/descend/plane_memo.h) looks such cubes up by a key that any plane and offset can
// compute: the heights of the plane over the cube's columns.
//
// Notation: n is the integer normal, w its dominant axis, u and v the other two, c = |n_w|, F the
// lattice units per voxel, o the plane's offset from the cube's corner. Axes along which n is
// negative are reflected. In reflected coordinates, in voxels, the plane's height over the point
// (i, j) is
//   h(i, j) = (o - zero) / (c F) - i |n_u| / c - j |n_v| / c,
//   zero = 7 F s + the first offset that sets the voxel at the corner, for s the sum of the
//   negative components of n (so 8 F s, except for rule thin, where the end is half-open).
// Voxel (i, j, k) is set iff k <= h(i, j) and h(i+1, j+1) <= k + 1 (thin: iff k = floor h(i, j)).
// So if no height is an integer, column (i, j) holds floor h(i+1, j+1) ... floor h(i, j) (thin:
// floor h(i, j)), as far as that is in 0 ... 7. Clamping the heights to [-1/2, 8 1/2] changes no
// voxel.
//
// Key: |n_u|, |n_v| <= c, so the floors of neighbouring heights differ by 0 or 1. Hence floor h(0,
// 0), the parities of the floors and the orientation (w and the reflected axes) determine every
// floor, and thus the voxels: 4 + 79 + 5 bits, exactly.
//
// Proof that fixed-point heights are enough: in units of 2^-26 voxel, h(0, 0) is rounded down, with
// relative errors of 3 * 2^-53 before, so it is wrong by less than 1.01; |n_u| / c and |n_v| / c
// are rounded to nearest, wrong by at most 0.51 each, times i, j <= 8. Together less than kMaxError
// = 10. A query is answered only if every fraction is at least kMaxError away from 0 and 1 for all
// offsets of the range: then the floors are right, and no height is an integer. The interval of
// offsets with the same content follows from the smallest and largest fraction. Everything else,
// all ties included, is left to the plane memo.
//
// Solid rules: the inside of the plane's sides (FilledSides) belongs to the key. Column (i, j) also
// holds all below floor h(i+1, j+1), all above floor h(i, j), or both.
//
// Rejected: contents for planes that the memo does not admit (small triangles: their contents
// rarely repeat), larger tables (they leave the CPU cache).
// Rejected as well: cubes of 16^3 voxels (a key of 17^2 heights costs as much as the four
// children that it saves).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "builder/descend/rules.h"
#include "builder/overlap/lattice_plane.h"
#include "builder/reduce/node_table.h"
#include "io/grid.h"
#include "streaming/memory/huge_pages.h"
#include "streaming/memory/multiply_fold.h"

namespace svdag {

struct PlaneMemoCounts {
  uint64_t queries = 0;   // cubes that one triangle or a patch covers, looked up in the memo
  uint64_t answered = 0;  // of these: answered, without a descent
  uint64_t hits = 0;      // nodes found, including nodes below the root of an answer
  uint64_t computed = 0;  // nodes computed

  PlaneMemoCounts& operator+=(const PlaneMemoCounts& other);
};

// Hash of two words for the tables of planes and contents.
inline uint64_t mix(uint64_t a, uint64_t b) noexcept {
  return multiply_fold(a ^ 0xa0761d6478bd642f, b ^ 0xe7037ed1a0b428db);
}

// The sides of a plane that are inside of a solid, as a mask. The low side has the smaller n . x.
using FilledSides = uint32_t;
constexpr FilledSides kLowSide = 1, kHighSide = 2;

// A set voxel of a cube, relative to the cube's corner, in one word; for cubes of up to 1024^3.
constexpr uint32_t pack_voxel(uint32_t x, uint32_t y, uint32_t z) noexcept {
  return x | y << 10 | z << 20;
}

// The content of a cube for all offsets in [low, high].
struct PlaneAnswer {
  int64_t low, high;
  uint32_t node;  // 1 + handle; 0: empty
  uint32_t voxels;
  uint32_t witness;  // a voxel that the plane sets, see pack_voxel(); kNoWitness: it sets none
};
constexpr uint32_t kNoWitness = UINT32_MAX;

// A plane, prepared for queries.
struct PlaneHeights {
  int64_t zero;            // offset of height 0 over (0, 0)
  int64_t unit;            // offset per voxel of height
  double scale;            // heights per offset, in units of 2^-kHeightBits voxels
  int32_t step_u, step_v;  // in these units
  int32_t drop;            // h(i, j) - drop is the lowest height in column (i, j)
  uint32_t orientation;    // w, and above it a bit per reflected axis
};

class PlaneContents {
 public:
  // A content looked up; valid until the next find(), settle() or drop().
  struct Query {
    uint64_t rows;
    uint32_t rest;
    int32_t first;  // h(0, 0)
    int64_t low, high;
    FilledSides sides;
    uint32_t set;
  };

  PlaneContents(int levels, Rule rule, const Kernels* kernels, NodeTable* table)
      : levels_(levels), rule_(surface_rule(rule)), kernels_(kernels), table_(table) {}

  // Level of the cubes.
  int level() const { return levels_ - 3; }
  // Memory of the largest table of at most `max_bytes`, in bytes; 0 if it would be of little use.
  static uint64_t table_bytes(uint64_t max_bytes);
  // Gives the cache its memory, `bytes` from table_bytes(). Before this every query fails.
  void allocate(uint64_t bytes);
  uint64_t bytes() const { return sets_.size_bytes(); }

  PlaneHeights heights_of(const int64_t n[3]) const;
  // Computes the key and prefetches its set. None if a height is, or may be, an integer.
  std::optional<Query> query(const PlaneHeights& plane, const OffsetRange& range,
                             FilledSides sides = 0) const;
  // Returns the content, after computing it if it is not cached.
  PlaneAnswer find(const PlaneHeights& plane, const Query& query, PlaneMemoCounts* counts);

  // Replaces pending handles; must be called after each flush of the table.
  void settle();
  // Discards all contents; must be called when the table is emptied.
  void drop();

 private:
  // One cache line, the most recently added content first.
  static constexpr int kWays = 3;
  struct alignas(64) Set {
    uint64_t rows[kWays];
    uint32_t rest[kWays];  // 0: free
    uint32_t node[kWays];
    uint16_t voxels[kWays];
    uint16_t witness[kWays];  // 3 bits per axis, or all bits: none
  };
  struct Content {
    uint32_t node, voxels, witness;
  };

  Content compute(const PlaneHeights& plane, const Query& query, PlaneMemoCounts* counts);
  Brick brick_voxels(const PlaneHeights& plane, int32_t first, FilledSides sides) const;

  int levels_;
  const SurfaceRule& rule_;
  const Kernels* kernels_;
  NodeTable* table_;
  HugePages memory_;
  std::span<Set> sets_;              // in memory_
  std::vector<uint32_t> unsettled_;  // sets with pending handles, since the last flush
};

}  // namespace svdag
