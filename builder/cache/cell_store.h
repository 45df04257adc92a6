// Sub-DAGs of cells that were baked before, found by what is in the cells.
//
// The voxelizer asks this interface; builder/cache/cell_cache.h answers from a folder.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "builder/octree/octree_cube.h"
#include "builder/overlap/triangle_list.h"
#include "builder/reduce/baked_run.h"

namespace svdag {

class CellStore {
 public:
  virtual ~CellStore() = default;

  // The key of `cube` with the triangles of `list`, which holds all that touch it.
  virtual CellKey key(const Cube& cube, const TriangleList& list) const = 0;
  // Whether the sub-DAG of `key` is known. If so it stands in `cube` now, and nobody bakes that.
  // From any thread.
  virtual bool take(const CellKey& key, const Cube& cube) = 0;
  // Hands over the taken cells as runs. target(bytes) decides whether a run of up to `bytes` is
  // spilled, and where to.
  virtual void taken(const std::function<std::optional<SpillTarget>(uint64_t)>& target,
                     const std::function<void(BakedRun)>& use) = 0;
  // Adds the cells of `baked` to what is known; `runs` holds the run if it was spilled. From any
  // thread.
  virtual void keep(const BakedRun& baked, SpillFile* runs) = 0;
  // Of the cells that were asked for, how many were known.
  virtual uint64_t hits() const = 0;
  // How many packs of cells were not looked at, for lack of memory.
  virtual uint64_t ignored() const = 0;
  // Why cells could not be kept; empty if all could.
  virtual std::string complaint() const = 0;
};

}  // namespace svdag
