// The points of files as a source of an import: each sets the voxel that holds it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/dag/layers/layer_table.h"
#include "io/formats/points/point_grid.h"
#include "io/voxel_source.h"

namespace svdag {

struct PointChoice {
  std::optional<double> voxel_size;  // -s; nothing: `levels`, or the grid of the file
  int levels = 0;                    // -r
  bool with_colours = true;
  LayerKind layers = LayerKind::kNone;  // --layers: kMaterial of the classes, kFile of the files
};

class PointVoxels {
 public:
  // Makes a first pass over the points; the summaries of `inputs` are filled. Colours are read if
  // all files have some. Errors: kUsage, kBadInput.
  PointVoxels(std::vector<PointInput> inputs, const PointChoice& choice);

  // kPoints, unless the points are the centres of exported voxels, on the grid of these.
  Rule rule() const { return rule_; }
  uint64_t count() const { return count_; }
  uint64_t left_out() const { return left_out_; }
  // The classes that occur, or the files.
  const LayerTable& layers() const { return layers_; }
  // The second pass.
  GridPlacement read(const VoxelSink& sink) const;

 private:
  void add_layers(LayerKind kind);
  void read(const PointInput& input, uint16_t label, const VoxelSink& sink) const;

  std::vector<PointInput> inputs_;
  uint64_t count_ = 0, left_out_ = 0;
  uint16_t brightest_ = 0;  // channel
  Rule rule_ = Rule::kPoints;
  Grid grid_;
  LayerTable layers_;
  std::vector<uint16_t> of_files_;          // layer of each file
  std::array<uint16_t, 256> of_classes_{};  // layer of each class
};

}  // namespace svdag
