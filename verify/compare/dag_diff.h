// The symmetric difference of two DAGs, without unpacking either.
//
// Two voxel sets are compared by descending both DAGs together. A pair of nodes (a, b) of one level
// always has the same difference, so it is computed once and cached: time is proportional to the
// number of different pairs, which for DAGs of one scene is about the number of nodes, not of
// voxels. A node without counterpart forms a pair with nothing.
//
// DAGs of different resolution are compared at the coarser one: there a voxel of the finer DAG is
// set if any voxel in it is.
//
// Rejected: comparing by content (a set of the finer DAG's subtrees): misses shifted contents.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/dag/dag_view.h"
#include "io/grid.h"

namespace svdag {

struct DiffCounts {
  uint64_t only_a = 0, only_b = 0;  // voxels
  uint64_t both = 0;
  uint64_t pairs = 0;  // distinct pairs of nodes compared
  bool same() const { return only_a == 0 && only_b == 0; }
};

// Receives a brick that differs; its coordinates are in bricks.
using DiffSink = std::function<bool(const std::array<uint32_t, 3>& brick, uint64_t a, uint64_t b)>;

// Receives a cube of a level that holds differences; its coordinates are in cubes.
using DiffCubeSink =
    std::function<void(const std::array<uint32_t, 3>& cube, uint64_t only_a, uint64_t only_b)>;

class DagDiff {
 public:
  // Both views must outlive this.
  DagDiff(const DagView& a, const DagView& b);

  // Log2 of the resolution of the comparison.
  uint32_t levels() const { return levels_; }
  DiffCounts count();
  // After count(): the bricks that differ, in Morton order, until the sink returns false.
  void visit(const DiffSink& sink);
  // After count(): the cubes of `level` (0 .. levels() - 2) that hold differences, in Morton order.
  void visit_cubes(uint32_t level, const DiffCubeSink& sink);

 private:
  struct Pair {
    uint32_t a, b;  // kNoChild: empty
  };
  struct Counts {
    uint64_t only_a = 0, only_b = 0, both = 0;
  };
  // The cached pairs of one level: a hash table with open addressing, grown at a load of 5/8.
  class Memo {
   public:
    Counts* find(Pair pair);
    void prefetch(Pair pair) const;
    void put(Pair pair, const Counts& counts);
    size_t size() const { return used_; }

   private:
    struct Slot {
      Pair pair{kNoChild, kNoChild};
      Counts counts;
    };
    size_t home_slot(Pair pair) const;
    void grow();

    std::vector<Slot> slots_;
    size_t used_ = 0;
  };

  Counts count(uint32_t level, Pair pair);
  void prefetch(uint32_t level, Pair pair) const;
  bool visit(uint32_t level, Pair pair, const std::array<uint32_t, 3>& at, const DiffSink& sink);
  void visit_cubes(uint32_t level, Pair pair, const std::array<uint32_t, 3>& at, uint32_t last,
                   const DiffCubeSink& sink);
  Pair root() const { return {a_.empty() ? kNoChild : 0, b_.empty() ? kNoChild : 0}; }
  std::array<uint64_t, 2> bricks_of(Pair pair) const;
  Pair child(uint32_t level, Pair pair, unsigned c) const;

  DagView a_, b_;
  uint32_t levels_;
  std::vector<Memo> memos_;  // [level], above the bricks
};

// Clusters of differences: where two DAGs differ, in a few boxes instead of millions of voxels.
//
// The grid is divided into 64^3 cells (of at least one brick). Cells that hold a difference and
// touch, by a face, edge or corner, are one cluster. So a cluster's box is exact to a cell.
// Rejected: clusters of single voxels, which take memory for each of them.
struct DiffCluster {
  VoxelBox box;  // of its cells, in voxels of the comparison
  uint64_t only_a = 0, only_b = 0;
};

// After diff->count(). The clusters with most differing voxels first; equal ones in Morton order.
std::vector<DiffCluster> diff_clusters(DagDiff* diff);

// Writes a binary PLY of the centres of differing voxels: red where only A is set, blue where only
// B. `grid` is A's. More than `max_points` voxels are an Error (kUsage). Call after diff->count().
void write_difference(DagDiff* diff, const DiffCounts& counts, const Grid& grid,
                      const std::string& path, uint64_t max_points);

}  // namespace svdag
