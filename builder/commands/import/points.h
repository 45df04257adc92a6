// The points of a file as a source of an import: each sets the voxel that holds it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "io/dag/layers/layer_table.h"
#include "io/formats/points/point_grid.h"
#include "io/voxel_source.h"

namespace svdag {

struct PointChoice {
  std::optional<double> voxel_size;  // -s; nothing: `levels`
  int levels = 0;                    // -r
  bool with_colours = true;
  bool with_classes = false;  // --layers class
};

class PointVoxels {
 public:
  // Makes a first pass over the points. Errors: kUsage, kBadInput.
  PointVoxels(std::unique_ptr<PointCloud> cloud, const std::string& path,
              const PointChoice& choice);

  const PointSummary& summary() const { return summary_; }
  // The classes that occur; no layers without PointChoice::with_classes.
  const LayerTable& layers() const { return layers_; }
  // The second pass.
  GridPlacement read(const VoxelSink& sink) const;

 private:
  std::unique_ptr<PointCloud> cloud_;
  std::string path_;
  PointSummary summary_;
  Grid grid_;
  LayerTable layers_;
  std::array<uint16_t, 256> labels_{};  // layer of each class
};

}  // namespace svdag
