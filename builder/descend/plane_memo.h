// Plane memo: what a plane leaves in a cube is computed once per content, not once per cube.
//
// Where one triangle covers a cube, the cube's voxels depend on the plane alone: on its normal n_q
// and on the offset o of the plane from the cube's corner (builder/overlap/lattice_plane.h). They
// stay the same while o lies between neighbouring lattice values, so every node computed carries
// the closed integer interval [low, high] of offsets with the same content:
//   a voxel with n_q . x in [l, h] on its closed cube is set iff l <= o <= h, so a hit leaves
//   [l, h], a miss (-inf, l-1] or [h+1, inf);
//   rule thin: set iff o in (m - d, m + d], m at the voxel's centre, 2d = |n_q,w| * side: the
//   dominant centre segment, which any other crossing implies;
//   a node leaves the intersection of its children's intervals, each shifted by n_q . corner.
// A query is a range of offsets that holds g = n_q . x over the triangle in the cube's column; an
// entry serves iff its interval holds the range. A range that straddles a lattice value is served
// by nobody: the caller descends. Why a range is exact although g varies: the triangle is a graph
// over the column; if it missed a voxel with l <= g <= h throughout, it would pass above (or below)
// the voxel's corner of largest (smallest) n_q . x, where g is beyond h (l).
//
// Repaying: a plane of A square voxels meets about A/s^2 cubes of side s but has at most 2(s+1)^3
// contents there (an axis-aligned one 2s+1). So entries are kept only for sizes that repeat, and a
// plane is admitted only when its bricks do. A is what its triangles have brought so far, which
// finds the tessellated wall too: no triangle of it is large. Rejected: half-open intervals in
// double (wrong on ties); a memo of child masks (no reuse between parallel planes).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "builder/octree/octree_cube.h"
#include "builder/overlap/kernels/kernels.h"
#include "builder/overlap/lattice_plane.h"
#include "builder/overlap/triangle_list.h"
#include "builder/reduce/node_table.h"
#include "io/dag/format.h"
#include "streaming/memory/huge_pages.h"

namespace svdag {

struct PlaneMemoCounts {
  uint64_t queries = 0;   // cubes that one triangle covers, put to the memo
  uint64_t answered = 0;  // of these: without descending
  uint64_t hits = 0;      // nodes found, inner ones of an answer included
  uint64_t computed = 0;  // nodes computed

  PlaneMemoCounts& operator+=(const PlaneMemoCounts& other);
};

// A voxel of a cube that is set, from the cube's corner; cubes of up to 1024^3 voxels.
struct Witness {
  int64_t voxel[3];
};

class PlaneMemo {
 public:
  // An entry is kept where a plane meets at least `repeats` cubes per content; 0 keeps all. Takes
  // at most `bytes`, and 1/32 of the table's memory budget, and needs none of it.
  PlaneMemo(int levels, Rule rule, const Kernels* kernels, double repeats, NodeTable* table,
            uint64_t bytes = UINT64_MAX);

  // What the memo knows about a triangle's plane.
  struct Known {
    LatticePlane plane;
    uint32_t number;       // of the plane
    int min_query_level;   // levels from this one on may be asked for
    int min_stored_level;  // levels from this one on repeat
  };
  // Admits the triangle, of which a cube of `side` voxels may be met; none if its plane does not
  // repay (yet) or has no integers. Valid until forget().
  std::optional<Known> admit(const TriangleSetup& t, double side);
  // Forgets all planes if they have become too many for the budget.
  void forget();

  // The sub-DAG of a cube (asked_from <= level <= brick level) that the triangle covers; none if
  // the memo can't tell.
  std::optional<SubDag> find(const Known& known, const Cube& cube);
  // The same for any triangles whose offsets are in `range`, provided that they have no border in
  // the cube (builder/descend/patch.h). *witness, if the cube is not empty, is a voxel that is set.
  std::optional<SubDag> find(const Known& known, const Cube& cube, const OffsetRange& range,
                             Witness* witness);
  // To be called after each flush of the table.
  void settle();
  // To be called when the table was emptied: what is known of the planes stays.
  void drop_contents();

  const PlaneMemoCounts& counts() const { return counts_; }

 private:
  struct Answer {
    int64_t low, high;
    uint32_t node;
    uint32_t voxels;
    uint32_t witness;  // a set voxel, see Witness
  };
  struct MemoEntry {
    int64_t low, high;
    uint32_t node;
    uint32_t voxels;
    uint32_t witness;
    uint32_t plane;  // 1 + plane number; 0: free
  };
  // The entries of one level: small cubes have few contents, so their table stays in the cache.
  struct LevelTable {
    HugePages memory;
    std::span<MemoEntry> entries;     // in `memory`; a set begins at a line of the cache
    std::vector<uint32_t> unsettled;  // entries written since the last flush
    size_t used = 0, limit = 0;
    uint32_t mask = 0;  // sets - 1
  };
  // A normal that was met.
  struct Normal {
    int64_t n[3];
    double area;      // square voxels that its triangles have brought
    uint32_t number;  // 1 + its place in planes_, once it was admitted
  };
  // What answering needs.
  struct Plane {
    int64_t n[3];
    int64_t negative, positive;          // sums of the components of either sign
    std::array<int8_t, 24> bucket_log2;  // [level]: about the length of an interval
    PlaneBrick brick;
  };
  static constexpr size_t kWays = 4;

  Normal* normal(const LatticePlane& plane);
  struct Contents {
    int dimensions;  // of the clusters of offsets
    double count;
    double length;  // of an interval
  };
  Contents contents(const int64_t n[3], int level) const;
  int first_level(const LatticePlane& plane) const;
  void add_plane(const Normal& normal);
  PlaneBrick plane_brick(const Plane& plane) const;
  bool node(uint32_t number, int level, const OffsetRange& range, Answer* out);
  void prefetch(uint32_t number, int level, int64_t offset);
  bool compute(uint32_t number, int level, const OffsetRange& range, Answer* out);
  bool compute_brick(const Plane& plane, const OffsetRange& range, Answer* out);
  static MemoEntry* set_of(LevelTable* table, uint32_t tag);
  void put(LevelTable* table, uint32_t tag, uint32_t plane, const Answer& answer);
  // Whether `bytes` more were granted.
  bool charge(uint64_t bytes);
  void grow(LevelTable* table);

  int levels_;
  Rule rule_;
  const Kernels* kernels_;
  double repeats_;
  NodeTable* table_;
  int min_stored_level_ = 0;        // of the current query
  std::vector<LevelTable> tables_;  // [level]
  std::vector<Plane> planes_;
  std::vector<Normal> normals_;
  std::vector<uint32_t> normal_slots_;  // open addressing by normal: 1 + place in normals_
  uint64_t max_bytes_;                  // bytes
  bool is_full_ = false;                // no plane can be added
  MemoryBudget::Reservation reservation_;
  PlaneMemoCounts counts_;
};

}  // namespace svdag
