// The layers that a scene has, in the order in which its triangles arrive.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "io/dag/layers/layer_table.h"
#include "io/scene/scene.h"

namespace svdag {

class SceneLayers {
 public:
  SceneLayers() = default;
  // `is_one_file`: the layer of the scene's only file is grey.
  explicit SceneLayers(LayerKind kind, bool is_one_file = false)
      : kind_(kind), is_grey_(is_one_file && kind == LayerKind::kFile) {}

  LayerKind kind() const { return kind_; }
  // The number of the layer of a batch. More than kMaxLayers are an Error (kUsage).
  uint32_t layer_of(const TriangleBatch& batch);
  // [number]: name and colour.
  const std::vector<Layer>& layers() const { return layers_; }
  // Restores what layers() returned.
  void restore(std::vector<Layer> layers);

 private:
  LayerKind kind_ = LayerKind::kNone;
  bool is_grey_ = false;
  std::vector<Layer> layers_;
  std::vector<bool> has_colour_;                       // from the scene
  std::unordered_map<std::string, uint32_t> numbers_;  // by name
  uint32_t last_ = 0;  // found last: batches of a layer follow one another
};

}  // namespace svdag
