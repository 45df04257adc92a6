// Interface of a store of baked cells, which finds the sub-DAG of a cell by its content.
//
// The voxelizer uses this interface; CellCache (builder/cache/cell_cache.h) implements it in a
// folder. Rejected: CellCache without an interface (a test acts between two phases of a bake
// through a store of its own).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "builder/octree/octree_cube.h"
#include "builder/overlap/triangle_list.h"
#include "builder/reduce/baked_run.h"

namespace svdag {

struct CellStoreCounts {
  uint64_t hits = 0;           // cells found in the store
  uint64_t skipped_packs = 0;  // for lack of memory
  std::string write_error;     // why cells could not be stored; empty if all were
};

class CellStore {
 public:
  virtual ~CellStore() = default;

  // The key of `cube`; `list` holds all triangles that touch it, `winding` is 0 unless the rule is
  // solid.
  virtual CellKey key(const Cube& cube, const TriangleList& list, int32_t winding) const = 0;
  // Returns true if the sub-DAG of `key` is stored, and takes it for `cube`, whose `sets` share
  // it: the caller then skips the descent, and load_taken() passes the sub-DAG later.
  // Thread-safe.
  virtual bool take(const CellKey& key, const Cube& cube, SubDagSets sets) = 0;
  // Passes the cells that were taken to `use`, as runs. target(bytes) decides whether a run of up
  // to `bytes` bytes is spilled, and where to.
  virtual void load_taken(const std::function<std::optional<SpillTarget>(uint64_t)>& target,
                          const std::function<void(BakedRun)>& use) = 0;
  // Stores the cells of `baked`; `runs` holds its run if that is spilled. Thread-safe.
  virtual void keep(const BakedRun& baked, SpillFile* runs) = 0;
  virtual CellStoreCounts counts() const = 0;
};

}  // namespace svdag
