// Bakes spilled triangles, bin by bin.
//
// A bin whose triangles fit in memory becomes a CellTree. A larger one is divided into bins of
// smaller cubes, which are baked in turn and freed. A small cube that still does not fit (10^9
// triangles in one voxel) is collected in a bitmap, batch by batch.
#pragma once

#include "builder/bake/voxelize.h"
#include "builder/split/split.h"

namespace svdag {

// Calls visit(bin) for the bins in order; each counts for progress by its triangles.
template <class Visit>
void for_each_bin(const std::vector<TriangleBin>& bins, Progress* progress, const Visit& visit) {
  double all = 0, done = 0;
  for (const TriangleBin& bin : bins) all += double(bin.triangles);
  for (const TriangleBin& bin : bins) {
    const double begin = done / all;
    done += double(bin.triangles);
    const Progress::Interval part(progress, begin, done / all);
    visit(bin);
  }
}

class BinBaker {
 public:
  // All must outlive the baker. `split` holds the cell level and the share of memory.
  BinBaker(const Grid& grid, const SplitConfig& split, const MortonSet* done, Voxelizer* voxelizer,
           MemoryBudget* budget, Executor* executor, Progress* progress);

  // `file` holds the bin. `windings`: for the solid rules, of the cubes of the bin's level or a
  // finer one; else null.
  void bake(SpillFile* file, const TriangleBin& bin, const CellWindings* windings);

 private:
  size_t materials() const;  // that cut
  // visit(&triangles, cuts) for batch after batch, until it returns false; whether it never did.
  template <class Visit>
  bool read(SpillFile* file, const TriangleBin& bin, size_t batch, const Visit& visit);
  // The winding numbers of the cubes of `level` in the bin; null if `known` has that level. The
  // bin's triangles are to be added.
  std::unique_ptr<CellWindings> finer_windings(const CellWindings* known, const Cube& cube,
                                               int level);
  bool bake_tree(SpillFile* file, const TriangleBin& bin, const CellWindings* windings);
  void bake_dense(SpillFile* file, const TriangleBin& bin, const CellWindings* windings);
  void bake_parts(SpillFile* file, const TriangleBin& bin, const CellWindings* windings);

  const Grid& grid_;
  const SplitConfig& split_;
  const MortonSet* done_;
  Voxelizer* voxelizer_;
  MemoryBudget* budget_;
  Executor* executor_;
  Progress* progress_;
};

}  // namespace svdag
