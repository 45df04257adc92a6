// What a solid rule needs of every triangle of the scene, collected while the split streams it: the
// winding numbers at the cells, whether the surface is closed, and the volume that it winds around.
#pragma once

#include <memory>

#include "builder/split/content_options.h"
#include "builder/winding/cell_windings.h"
#include "io/scene/boundary_chain.h"
#include "io/scene/open_parts.h"

namespace svdag {

class SolidWatch {
 public:
  // Finds the open parts, in passes of their own over the scene, if the options allow them.
  SolidWatch(const Scene& scene, const Grid& grid, const ContentOptions& options,
             MemoryBudget* budget);

  // The sheet (io/triangle.h) of the triangles of `batch`.
  uint32_t sheet_of(const TriangleBatch& batch) const;
  // Adds a snapped triangle, also one that misses the grid.
  void add(const LatticeTriangle& triangle);
  // After the last triangle. Error (kBadInput) unless the rule is defined for the surface.
  std::shared_ptr<const CellWindings> finish();

  size_t open_parts() const { return open_parts_.size(); }
  size_t open_layers() const { return open_layers_.size(); }
  // That the closed parts wind around, signed, in voxels.
  double volume() const { return volume_; }

 private:
  const Scene& scene_;
  const Grid& grid_;
  Rule rule_;
  bool are_frames_;  // the layers, each of which has to be closed
  std::shared_ptr<CellWindings> windings_;
  OpenParts open_parts_, open_layers_;
  EdgeSum edges_;  // of the closed parts
  double volume_ = 0;
};

}  // namespace svdag
