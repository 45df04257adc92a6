// The layer of each exported voxel, for formats that store colours or labels (ply, npz, vox).
#pragma once

#include "io/dag/dag_file.h"
#include "io/voxel_source.h"

namespace svdag {

class LayerLabels {
 public:
  // `file` has layers, and must outlive this. `level`: of the exported voxels.
  LayerLabels(const DagFile& file, int level)
      : file_(file), index_(file.layer_index()), view_(index_.view()), level_(uint32_t(level)) {}

  // The number of the first layer, in the order of the table, that has a voxel in this one.
  uint32_t of(const Voxel& voxel) const {
    const uint32_t shift = file_.view().levels - level_;
    const uint32_t label = layer_of_cube(file_.view(), view_, level_, voxel[0] << shift,
                                         voxel[1] << shift, voxel[2] << shift);
    SVDAG_ASSERT(label != kNoLayer);
    return label;
  }
  LayerKind kind() const { return file_.layers().kind; }
  const std::vector<Layer>& layers() const { return file_.layers().layers; }
  const Colour& colour_of(const Voxel& voxel) const { return layers()[of(voxel)].colour; }

 private:
  const DagFile& file_;
  LayerIndex index_;
  LayerIndexView view_;
  uint32_t level_;
};

}  // namespace svdag
