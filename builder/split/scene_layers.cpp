#include "builder/split/scene_layers.h"

#include "io/dag/layers/layer_table.h"
#include "streaming/error.h"

namespace svdag {

uint32_t SceneLayers::layer_of(const TriangleBatch& batch) {
  const std::string_view name = part_name(batch, part_of(kind_));
  if (last_ >= layers_.size() || layers_[last_].name != name) {
    const auto [found, is_new] = numbers_.try_emplace(std::string(name), uint32_t(layers_.size()));
    last_ = found->second;
    if (is_new && layers_.size() == kMaxLayers)
      fail_usage(std::string("--layers ") + layer_kind_name(kind_) + ": the scene has more than " +
                 std::to_string(kMaxLayers) + " of these");
    if (is_new) {
      layers_.push_back({std::string(name), is_grey_ ? kNeutralColour : palette_colour(name)});
      has_colour_.push_back(false);
    }
  }
  // The smallest, since the order of the scene must not decide.
  Colour& colour = layers_[last_].colour;
  if (kind_ == LayerKind::kMaterial && batch.colour &&
      (!has_colour_[last_] || *batch.colour < colour)) {
    colour = *batch.colour;
    has_colour_[last_] = true;
  }
  return last_;
}

void SceneLayers::restore(std::vector<Layer> layers) {
  layers_ = std::move(layers);
  has_colour_.assign(layers_.size(), true);
  for (uint32_t i = 0; i < layers_.size(); ++i) numbers_[layers_[i].name] = i;
}

}  // namespace svdag
