#include "io/scene/gltf/document/tile.h"

#include <gmock/gmock.h>

#include <cmath>

#include "io/scene/scene.h"
#include "tests/io/scene/gltf/gltf_builder.h"
#include "tests/io/scene/read_text.h"

namespace svdag {
namespace {

using json = nlohmann::json;
using Points = std::vector<std::array<double, 3>>;
using testing::HasSubstr;

// A triangle whose corners tell the axes apart.
GltfBuilder corners() {
  GltfBuilder gltf;
  gltf.show(gltf.mesh(gltf.accessor(std::vector<float>{1, 0, 0, 0, 2, 0, 0, 0, 3}, "VEC3")));
  return gltf;
}

std::string numbers(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

std::string tile(const std::string& magic, const json& features, const std::string& binary,
                 const std::string& content, const std::string& format = "") {
  std::string text = features.dump();
  text.resize((text.size() + 7) / 8 * 8, ' ');
  const size_t head = 28 + format.size();
  return magic + GltfBuilder::u32(1) +
         GltfBuilder::u32(head + text.size() + binary.size() + content.size()) +
         GltfBuilder::u32(text.size()) + GltfBuilder::u32(binary.size()) + GltfBuilder::u32(0) +
         GltfBuilder::u32(0) + format + text + binary + content;
}

std::string batched_tile(const json& features, const std::string& binary = "") {
  return tile("b3dm", features, binary, corners().glb());
}

std::string instanced_tile(const json& features, const std::string& binary) {
  return tile("i3dm", features, binary, corners().glb(), GltfBuilder::u32(1));
}

Points read_points(const std::string& bytes) {
  Points points;
  for (const Corners& triangle : read(read_gltf, bytes).triangles)
    points.insert(points.end(), triangle.begin(), triangle.end());
  return points;
}

// y becomes z, and z becomes -y.
TEST(Tile, BatchedIsTurnedToZAndMovedToItsCentre) {
  EXPECT_EQ(read_points(batched_tile({{"BATCH_LENGTH", 0}})),
            (Points{{1, 0, 0}, {0, 0, 2}, {0, -3, 0}}));
  const Points moved = {{1e6 + 1, 2, 3}, {1e6, 2, 5}, {1e6, -1, 3}};
  EXPECT_EQ(read_points(batched_tile({{"RTC_CENTER", {1e6, 2, 3}}})), moved);
  EXPECT_EQ(
      read_points(batched_tile({{"RTC_CENTER", {{"byteOffset", 4}}}}, numbers({9, 1e6, 2, 3}))),
      moved);
}

TEST(Tile, CesiumRtcMovesAlike) {
  GltfBuilder gltf = corners();
  gltf.json["extensionsRequired"] = {"CESIUM_RTC"};
  gltf.json["extensions"] = {{"CESIUM_RTC", {{"center", {10, 20, 30}}}}};
  EXPECT_EQ(read_points(tile("b3dm", json::object(), "", gltf.glb())),
            (Points{{11, 20, 30}, {10, 20, 32}, {10, 17, 30}}));
}

TEST(Tile, InstancesArePlaced) {
  json features = {{"INSTANCES_LENGTH", 2}, {"POSITION", {{"byteOffset", 0}}}};
  const std::string positions = numbers({0, 0, 0, 5, 6, 7});
  EXPECT_EQ(read_points(instanced_tile(features, positions)),
            (Points{{1, 0, 0}, {0, 0, 2}, {0, -3, 0}, {6, 6, 7}, {5, 6, 9}, {5, 3, 7}}));
  features["SCALE"] = {{"byteOffset", 24}};
  features["RTC_CENTER"] = {100, 0, 0};
  EXPECT_EQ(
      read_points(instanced_tile(features, positions + numbers({1, 2}))),
      (Points{{101, 0, 0}, {100, 0, 2}, {100, -3, 0}, {107, 6, 7}, {105, 6, 11}, {105, 0, 7}}));
}

// right = y, up = -x: x becomes y, y becomes -x.
TEST(Tile, InstancesAreOriented) {
  json features = {{"INSTANCES_LENGTH", 1},
                   {"POSITION", {{"byteOffset", 0}}},
                   {"NORMAL_RIGHT", {{"byteOffset", 12}}},
                   {"NORMAL_UP", {{"byteOffset", 24}}},
                   {"SCALE_NON_UNIFORM", {{"byteOffset", 36}}}};
  const std::string binary = numbers({0, 0, 0, 0, 1, 0, -1, 0, 0, 2, 3, 4});
  // The corners of the turned model are (1, 0, 0), (0, 0, 2) and (0, -3, 0).
  const Points expected = {{0, 2, 0}, {0, 0, 8}, {9, 0, 0}};
  EXPECT_EQ(read_points(instanced_tile(features, binary)), expected);
  features["EAST_NORTH_UP"] = true;  // directions come first
  EXPECT_EQ(read_points(instanced_tile(features, binary)), expected);
}

TEST(Tile, QuantisedInstancesAreDecoded) {
  const auto codes = [](std::initializer_list<uint16_t> values) {
    return std::string(reinterpret_cast<const char*>(std::data(values)), 2 * values.size());
  };
  const json features = {{"INSTANCES_LENGTH", 1},
                         {"POSITION_QUANTIZED", {{"byteOffset", 0}}},
                         {"QUANTIZED_VOLUME_OFFSET", {1, 2, 3}},
                         {"QUANTIZED_VOLUME_SCALE", {10, 20, 30}},
                         {"NORMAL_RIGHT_OCT32P", {{"byteOffset", 6}}},
                         {"NORMAL_UP_OCT32P", {{"byteOffset", 10}}}};
  // right = (0, 1, 0), up = (-1, 0, 0).
  const Points points =
      read_points(instanced_tile(features, codes({0, 65535, 13107, 32768, 65535, 0, 32768})));
  const Points expected = {{1, 23, 9}, {1, 22, 11}, {4, 22, 9}};
  ASSERT_EQ(points.size(), 3U);
  for (size_t i = 0; i < 3; ++i) {
    for (size_t a = 0; a < 3; ++a) EXPECT_NEAR(points[i][a], expected[i][a], 1e-3) << i << a;
  }
}

TEST(Tile, AGltfBesideIsPlacedAndIsAFileOfTheScene) {
  const TempFolder folder;
  folder.write("tree.glb", corners().glb());
  const std::string path = folder.write(
      "tile.i3dm", tile("i3dm", {{"INSTANCES_LENGTH", 1}, {"POSITION", {{"byteOffset", 0}}}},
                        numbers({1, 1, 1}), "tree.glb  ", GltfBuilder::u32(0)));
  MemoryBudget budget;
  SceneConfig config;
  config.paths = {path};
  const Scene scene(config, &budget);
  const Box box = scene.bounds();
  EXPECT_EQ(box.min, Point(1, -2, 1));
  EXPECT_EQ(box.max, Point(2, 1, 3));
  size_t files = 0;
  scene.visit_files([&](const File&) { ++files; });
  EXPECT_EQ(files, 2U);
}

TEST(Tile, DamagedTilesAreRefused) {
  const json one = {{"INSTANCES_LENGTH", 1}, {"POSITION", {{"byteOffset", 0}}}};
  const std::string position = numbers({0, 0, 0});
  json many = one, far = one, east = one, half = one;
  many["INSTANCES_LENGTH"] = uint64_t(1) << 62;
  far["POSITION"]["byteOffset"] = uint64_t(1) << 63;
  east["EAST_NORTH_UP"] = true;
  half["NORMAL_UP"] = {{"byteOffset", 0}};
  EXPECT_THAT(refusal(read_gltf, instanced_tile(many, position)), HasSubstr("feature table"));
  EXPECT_THAT(refusal(read_gltf, instanced_tile(far, position)), HasSubstr("feature table"));
  EXPECT_THAT(refusal(read_gltf, instanced_tile(east, position)), HasSubstr("EAST_NORTH_UP"));
  EXPECT_THAT(refusal(read_gltf, instanced_tile(half, position)), HasSubstr("two directions"));
  EXPECT_THAT(refusal(read_gltf, instanced_tile({{"INSTANCES_LENGTH", 1}}, "")),
              HasSubstr("without positions"));
  const std::string whole = instanced_tile(one, position);
  for (size_t size = 8; size < whole.size(); ++size)
    EXPECT_NE(refusal(read_gltf, whole.substr(0, size)), "") << size;
}

}  // namespace
}  // namespace svdag
