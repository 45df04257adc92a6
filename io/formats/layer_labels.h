// The layer of each exported voxel, for formats that store colours or labels.
#pragma once

#include <bit>
#include <optional>

#include "io/dag/dag_file.h"
#include "io/dag/walk/cube_walk.h"
#include "io/voxel_source.h"

namespace svdag {

constexpr Colour kNoLayerColour = kNeutralColour;

class LayerLabels {
 public:
  // `file` has layers, and must outlive this. `level`: of the exported voxels.
  LayerLabels(const DagFile& file, int level)
      : file_(file), index_(file.layer_index()), view_(index_.view()), level_(uint32_t(level)) {}

  // The number of the first layer, in the order of the table, that has a voxel in this one;
  // kNoLayer if none has: an inside that only the union encloses (docs/format.md, "Layers").
  uint32_t of(const Voxel& voxel) const {
    const uint32_t shift = file_.view().levels - level_;
    return layer_of_cube(file_.view(), view_, level_, voxel[0] << shift, voxel[1] << shift,
                         voxel[2] << shift);
  }
  LayerKind kind() const { return file_.layers().kind; }
  const std::vector<Layer>& layers() const { return file_.layers().layers; }
  Colour colour_of(const Voxel& voxel) const {
    const uint32_t label = of(voxel);
    return label == kNoLayer ? kNoLayerColour : layers()[label].colour;
  }
  // The label of all voxels of a full cube that `walk`, of the same file and level, visits; nothing
  // if they differ. That is the cube's first layer, if it fills the cube.
  std::optional<uint32_t> of_full_cube(const VoxelCube& cube, CubeWalk* walk) const {
    const uint32_t level = level_ - uint32_t(std::countr_zero(uint64_t(cube.side)));
    if (level == 0) return std::nullopt;  // its node is in other views another one
    const DagView& dag = file_.view();
    const uint32_t shift = dag.levels - level_;
    const LatticePoint at = cube.origin << LatticePoint(shift);
    const uint32_t label =
        layer_of_cube(dag, view_, level, uint32_t(at.x), uint32_t(at.y), uint32_t(at.z));
    if (label == kNoLayer) return label;
    const DagView layer = file_.view_of(label);
    uint32_t node = 0;
    for (uint32_t k = 0; k < level; ++k) {
      const unsigned c =
          octant_of(uint32_t(at.x), uint32_t(at.y), uint32_t(at.z), dag.levels - 1 - k);
      node = dag_present_child(layer, k, node, c);
    }
    return walk->is_full(level, node) ? std::optional(label) : std::nullopt;
  }

 private:
  const DagFile& file_;
  LayerIndex index_;
  LayerIndexView view_;
  uint32_t level_;
};

}  // namespace svdag
