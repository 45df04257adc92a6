// The layers of a scene: their names, colours and number.
#include "builder/split/scene_layers.h"

#include <gtest/gtest.h>

#include "io/dag/layers/layer_table.h"
#include "tests/expect_error.h"

namespace svdag {
namespace {

TriangleBatch batch_of(const std::string& material, std::optional<Colour> colour = {}) {
  TriangleBatch batch;
  batch.mesh = "an object";
  batch.material = material;
  batch.colour = colour;
  return batch;
}

TEST(SceneLayers, EqualNamesAreOneLayerAndTheEmptyNameIsOne) {
  SceneLayers layers(LayerKind::kMaterial);
  const std::string names[] = {"a", "", "a", "b", "", "b"};
  std::vector<uint32_t> numbers;
  for (const std::string& name : names) numbers.push_back(layers.layer_of(batch_of(name)));
  EXPECT_EQ(numbers, (std::vector<uint32_t>{0, 1, 0, 2, 1, 2}));
}

TEST(SceneLayers, TheColourIsTheSmallestOfTheMaterialInAnyOrder) {
  const Colour low{1, 200, 3}, high{1, 201, 0};
  for (const auto& [first, second] : {std::pair(low, high), std::pair(high, low)}) {
    SceneLayers layers(LayerKind::kMaterial);
    for (const std::optional<Colour> colour : {std::optional(first), std::optional(second), {}})
      layers.layer_of(batch_of("a", colour));
    EXPECT_EQ(layers.layers()[0].colour, low);
  }
}

TEST(SceneLayers, ColoursOfMaterialsAreNotThoseOfObjects) {
  SceneLayers layers(LayerKind::kObject);
  layers.layer_of(batch_of("a", Colour{1, 2, 3}));
  EXPECT_EQ(layers.layers()[0].colour, palette_colour("an object"));
}

TEST(SceneLayers, MoreThanTheFormatHoldsAreAnError) {
  SceneLayers layers(LayerKind::kMaterial);
  for (uint32_t i = 0; i < kMaxLayers; ++i) layers.layer_of(batch_of(std::to_string(i)));
  EXPECT_EQ(layers.layer_of(batch_of("7")), 7U);
  EXPECT_SVDAG_ERROR(layers.layer_of(batch_of("one more")), ExitCode::kUsage,
                     "--layers material: the scene has more than 65535 of these");
}

}  // namespace
}  // namespace svdag
