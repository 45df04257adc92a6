// Plane memo: a cache of the content of cubes that a plane crosses, computed once per content
// instead of once per cube.
//
// Where one triangle covers a cube, the cube's voxels depend only on the plane: on its normal n_q
// and on the offset o of the plane from the cube's corner (builder/overlap/lattice_plane.h). They
// do not change while o is between two neighbouring critical values, so every computed node has a
// closed integer interval [low, high] of offsets with the same content:
//   a voxel with n_q . x in [l, h] on its closed cube is set iff l <= o <= h, so its interval is
//   [l, h] if it is set, (-inf, l-1] or [h+1, inf) if it is clear;
//   thin rule: set iff o in (m - d, m + d], m at the voxel's centre, 2d = |n_q,w| * side. That is
//   the dominant centre segment; a crossing of any other one implies a crossing of this one;
//   the interval of a node is the intersection of its children's, each shifted by n_q . corner.
// A query is a range of offsets that contains g = n_q . x over the triangle in the cube's column.
// An entry answers it iff its interval contains the range. No entry answers a range that straddles
// a critical value; the caller then descends. A range is exact although g varies: the triangle is a
// graph over the column, and if it missed a voxel with l <= g <= h throughout, it would pass above
// (or below) the voxel's corner of largest (smallest) n_q . x, where g would be beyond h (l).
//
// Solid rules: the untouched voxels of the cube are on two sides of the plane, and each side is
// inside or outside as a whole: a voxel above all offsets of the range is connected through such
// voxels to the cube's extreme voxel along n_q, and so is one below to the opposite extreme voxel.
// So the content depends on two more bits, FilledSides, and entries are stored for each. A side
// without voxels counts as not filled, so that equal contents have equal keys. Rejected: the jump
// of the winding number at one column (a patch may have holes outside of the cube).
//
// Entries are stored per plane for cubes of at least 16^3 voxels; below, planes share the contents
// of cubes of 8^3 voxels (builder/descend/plane_contents.h), and what that cache cannot answer is
// computed.
//
// When it pays: a plane of A square voxels meets about A/s^2 cubes of side s but has at most
// 2(s+1)^3 contents there (2s+1 if it is axis-aligned). So entries are stored only for cube sizes
// whose contents repeat, and a plane is admitted only when its bricks do. A is the area of the
// triangles so far, so tessellated walls are found too, although none of their triangles is large.
// Rejected: half-open intervals in double (wrong on ties); a memo of child masks (no reuse between
// parallel planes).
// Rejected as well: one table for all levels (entries of bricks leave the CPU cache), larger
// tables (fewer bricks computed, no less time), all eight children looked up before the first is
// answered (their sets are cached already).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "builder/descend/full_nodes.h"
#include "builder/descend/plane_contents.h"
#include "builder/octree/octree_cube.h"
#include "builder/overlap/kernels/kernels.h"
#include "builder/overlap/lattice_plane.h"
#include "builder/overlap/triangle_list.h"
#include "builder/reduce/node_table.h"
#include "io/dag/format.h"
#include "streaming/memory/huge_pages.h"

namespace svdag {

// A set voxel of a cube, relative to the cube's corner; for cubes of up to 1024^3 voxels.
struct Witness {
  int64_t voxel[3];
};

class PlaneMemo {
 public:
  // Entries are stored where a plane meets at least `repeats` cubes per content; 0: all are. Takes
  // at most `bytes` and 1/32 of the memory budget of `table`, and works without any memory.
  // `full` is of the same table.
  PlaneMemo(int levels, Rule rule, const Kernels* kernels, double repeats, NodeTable* table,
            FullNodes* full, uint64_t bytes = UINT64_MAX);

  // An admitted triangle's plane.
  struct AdmittedPlane {
    LatticePlane plane;
    uint32_t number;       // index of the plane
    int min_query_level;   // cubes of this level and finer ones may be looked up
    int min_stored_level;  // cubes of this level and finer ones are stored
  };
  // Admits the plane of a triangle, which is met in a cell of `side` voxels a side. None if the
  // plane does not pay off (yet) or has no integer form. Valid until forget().
  std::optional<AdmittedPlane> admit(const TriangleSetup& t, double side);
  // Discards all planes if they have exceeded the memory.
  void forget();

  // The sub-DAG of a cube (min_query_level <= level <= brick level), if triangles with offsets in
  // `range` cover all of the cube that the plane meets; none if the range straddles a critical
  // value. `sides` is 0 except for the solid rules. *witness is a voxel that the plane sets, if
  // there is any.
  std::optional<SubDag> find(const AdmittedPlane& known, const Cube& cube, const OffsetRange& range,
                             FilledSides sides, std::optional<Witness>* witness);
  // Replaces pending handles; must be called after each flush of the table.
  void settle();
  // Discards all entries but keeps the planes; must be called when the table is emptied.
  void drop_contents();

  const PlaneMemoCounts& counts() const { return counts_; }

 private:
  struct MemoEntry {
    int64_t low, high;
    uint32_t node;
    uint32_t voxels;
    uint32_t witness;
    uint32_t plane;  // 1 + 4 * plane number + filled sides; 0: free
  };
  // The entries of one level.
  struct LevelTable {
    HugePages memory;
    std::span<MemoEntry> entries;     // in `memory`; a set begins at a cache line
    std::vector<uint32_t> unsettled;  // entries with pending handles, since the last flush
    size_t used = 0, limit = 0;
    uint32_t mask = 0;  // sets - 1
  };
  // A normal of the triangles so far.
  struct Normal {
    int64_t n[3];
    double area;      // total area of its triangles, in square voxels
    uint32_t number;  // 1 + index in planes_; 0: not admitted
  };
  // An admitted plane, prepared for queries.
  struct Plane {
    int64_t n[3];
    int64_t negative, positive;          // sums of the negative and of the positive components
    std::array<int8_t, 24> bucket_log2;  // [level]: approximate length of an interval
    PlaneBrick brick;
    PlaneHeights heights;
  };
  static constexpr size_t kWays = 4;

  Normal* find_normal(const LatticePlane& plane);
  struct ContentEstimate {
    int dimensions;  // number of dimensions of the clusters of offsets
    double count;
    double length;  // of an interval
  };
  ContentEstimate estimate_contents(const int64_t n[3], int level) const;
  int first_level(const LatticePlane& plane) const;
  void add_plane(const Normal& normal);
  PlaneBrick make_plane_brick(const Plane& plane) const;
  FilledSides sides_with_voxels(const Plane& plane, int level, const OffsetRange& range) const;
  bool find_node(uint32_t number, int level, const OffsetRange& range, FilledSides sides,
                 PlaneAnswer* out);
  void prefetch(uint32_t number, int level, int64_t offset, FilledSides sides);
  bool compute(uint32_t number, int level, const OffsetRange& range, FilledSides sides,
               PlaneAnswer* out) {
    return sides == 0 ? compute_children<false>(number, level, range, 0, out)
                      : compute_children<true>(number, level, range, sides, out);
  }
  // kFilled: some side is filled; without, surfaces take no longer than they need.
  template <bool kFilled>
  bool compute_children(uint32_t number, int level, const OffsetRange& range, FilledSides sides,
                        PlaneAnswer* out);
  bool compute_brick(const Plane& plane, const OffsetRange& range, FilledSides sides,
                     PlaneAnswer* out);
  static MemoEntry* set_of(LevelTable* table, uint32_t tag);
  void put(LevelTable* table, uint32_t tag, uint32_t key, const PlaneAnswer& answer);
  // Reserves `bytes` more; false if the budget does not allow it.
  bool charge(uint64_t bytes);
  void grow(LevelTable* table);

  int levels_;
  Rule rule_;
  const Kernels* kernels_;
  double repeats_;
  NodeTable* table_;
  FullNodes* full_;
  int min_stored_level_ = 0;        // of the current query
  std::vector<LevelTable> tables_;  // [level], of cubes of at least 16^3 voxels
  PlaneContents contents_;          // the cubes of 8^3 voxels
  std::vector<Plane> planes_;
  std::vector<Normal> normals_;
  std::vector<uint32_t> normal_slots_;  // open addressing by normal: 1 + index in normals_
  uint64_t max_bytes_;                  // of the memo
  bool is_full_ = false;                // no plane can be added until forget()
  MemoryBudget::Reservation reservation_;
  PlaneMemoCounts counts_;
};

}  // namespace svdag
