// Finds the layer of a voxel: the first, in the order of the table, that holds it. For host and
// CUDA code.
//
// For each cube of a coarse level, in Morton order, the index lists the layers that have voxels in
// it, with their nodes of that level. A cube usually has few: 2.1 in Crytek Sponza by its 25
// objects, so a look-up descends about two paths. Rejected: all layers one after the other
// (thousands of descents), a layer per voxel (no file would be small).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "io/dag/dag_view.h"

namespace svdag {

constexpr uint32_t kNoLayer = 0xffffffffU;

struct LayerIndexView {
  struct Entry {
    uint32_t layer, node;
  };
  uint32_t level = 0;               // of the cubes
  const uint32_t* begin = nullptr;  // [cube], and one past the last: position in entries
  const Entry* entries = nullptr;   // ascending by layer in each cube

  // The Morton number of the cube that holds voxel (x, y, z) of 2^levels per axis.
  SVDAG_HD uint32_t cube_of(uint32_t levels, uint32_t x, uint32_t y, uint32_t z) const {
    uint32_t cube = 0;
    for (uint32_t shift = levels; shift-- > levels - level;)
      cube = cube << 3 | octant_of(x, y, z, shift);
    return cube;
  }
};

// Whether the cube of level `to` that holds voxel (x, y, z) has a voxel; `node`, of `level` <= the
// brick level, is on its path.
SVDAG_HD inline bool dag_cube_is_set(const DagView& dag, uint32_t level, uint32_t node, uint32_t to,
                                     uint32_t x, uint32_t y, uint32_t z) {
  for (; level < dag.brick_level(); ++level) {
    if (level >= to) return true;
    node = dag_child(dag, level, node, octant_of(x, y, z, dag.levels - 1 - level));
    if (node == kNoChild) return false;
  }
  if (to <= level) return true;
  const uint32_t block = uint32_t(dag.bricks[node] >> 8 * octant_of(x, y, z, 1)) & 0xffU;
  return to < dag.levels ? block != 0 : (block >> octant_of(x, y, z, 0) & 1U) != 0;
}

// The first layer with a voxel in the cube of level `to` <= L that holds voxel (x, y, z); kNoLayer
// if there is none. `dag`: the view of the file.
SVDAG_HD inline uint32_t layer_of_cube(const DagView& dag, const LayerIndexView& index, uint32_t to,
                                       uint32_t x, uint32_t y, uint32_t z) {
  const uint32_t cube = index.cube_of(dag.levels, x, y, z);
  uint32_t found = kNoLayer;
  if (to < index.level) {  // a cube of several of the index
    const uint32_t shift = 3 * (index.level - to), first = cube >> shift << shift;
    for (uint32_t i = index.begin[first]; i < index.begin[first + (1U << shift)]; ++i)
      found = index.entries[i].layer < found ? index.entries[i].layer : found;
    return found;
  }
  for (uint32_t i = index.begin[cube]; i < index.begin[cube + 1]; ++i) {
    if (dag_cube_is_set(dag, index.level, index.entries[i].node, to, x, y, z))
      return index.entries[i].layer;
  }
  return kNoLayer;
}

class LayerIndex {
 public:
  // `view_of(layer)`: the views of `layers` layers of a file of `levels` levels, which must outlive
  // this. Holds at most 33 MiB, whatever the layers.
  LayerIndex(uint32_t levels, size_t layers, const std::function<DagView(size_t)>& view_of);

  LayerIndexView view() const { return {level_, begin_.data(), entries_.data()}; }
  std::span<const uint32_t> begin() const { return begin_; }
  std::span<const LayerIndexView::Entry> entries() const { return entries_; }

 private:
  uint32_t level_;
  std::vector<uint32_t> begin_;
  std::vector<LayerIndexView::Entry> entries_;
};

}  // namespace svdag
