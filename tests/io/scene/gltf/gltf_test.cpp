// The glTF reader: every way to store a triangle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/scene/scene.h"
#include "tests/io/scene/gltf/gltf_builder.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

const CornerList kTriangleCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
// Five vertices on a line of x, so that x identifies the vertex of a corner.
const std::vector<float> kFive = {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0};

std::vector<int> corner_numbers(const CornerList& corners) {
  std::vector<int> numbers;
  for (const auto& c : corners) numbers.push_back(int(c[0]));
  return numbers;
}

TEST(Gltf, ReadsCornersWithoutIndices) {
  EXPECT_EQ(read_corners(one_triangle()), kTriangleCorners);
}

TEST(Gltf, ReadsIndicesOfEveryUnsignedType) {
  const auto read = [](const auto& indices) {
    GltfBuilder gltf;
    const int positions = gltf.accessor(kTriangle, "VEC3");
    gltf.show(gltf.mesh(positions, gltf.accessor(indices, "SCALAR")));
    return read_corners(gltf);
  };
  const CornerList turned = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(read(std::vector<uint8_t>{1, 2, 0}), turned);
  EXPECT_EQ(read(std::vector<uint16_t>{1, 2, 0}), turned);
  EXPECT_EQ(read(std::vector<uint32_t>{1, 2, 0}), turned);
}

TEST(Gltf, StripsAndFansAreOrderedAsSpecified) {
  for (const bool indexed : {false, true}) {
    const auto read = [&](int mode) {
      GltfBuilder gltf;
      const int positions = gltf.accessor(kFive, "VEC3");
      const int indices =
          indexed ? gltf.accessor(std::vector<uint16_t>{0, 1, 2, 3, 4}, "SCALAR") : -1;
      gltf.show(gltf.mesh(positions, indices, mode));
      return corner_numbers(read_corners(gltf));
    };
    EXPECT_THAT(read(5), ElementsAre(0, 1, 2, 1, 3, 2, 2, 3, 4));
    EXPECT_THAT(read(6), ElementsAre(1, 2, 0, 2, 3, 0, 3, 4, 0));
  }
}

TEST(Gltf, PointsAndLinesHaveNoTriangles) {
  for (const int mode : {0, 1, 2, 3}) {
    GltfBuilder gltf;
    gltf.show(gltf.mesh(gltf.accessor(kFive, "VEC3"), -1, mode));
    EXPECT_TRUE(read_corners(gltf).empty()) << "mode " << mode;
  }
}

// A skin needs joints; weights without targets move nothing.
TEST(Gltf, TrianglesThatStayAsStoredAreCounted) {
  const auto undeformed = [](const json& node, const json& mesh) {
    GltfBuilder gltf = one_triangle();
    gltf.json["nodes"][0].update(node);
    gltf.json["meshes"][0].update(mesh);
    const TempFolder folder;
    MemoryBudget budget;
    const Scene scene({.paths = {folder.write("scene.glb", gltf.glb())}, .names = {}}, &budget);
    return scene.stream([](const TriangleBatch&) {}).undeformed;
  };
  EXPECT_EQ(undeformed(json::object(), json::object()), 0u);
  EXPECT_EQ(undeformed({{"skin", 0}}, json::object()), 1u);
  EXPECT_EQ(undeformed(json::object(), {{"weights", {0, 0.5}}}), 0u);
}

TEST(Gltf, ListsBeyondOneWindowComeWhole) {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < 30000; ++i) {
    positions.insert(positions.end(), {float(i), 0, 0});
    indices.push_back(29999 - i);
  }
  GltfBuilder gltf;
  const int p = gltf.accessor(positions, "VEC3");
  gltf.json["meshes"] = json::array();
  gltf.scene({gltf.append("nodes", {{"mesh", gltf.mesh(p)}}),
              gltf.append("nodes", {{"mesh", gltf.mesh(p, gltf.accessor(indices, "SCALAR"))}})});
  const CornerList corners = read_corners(gltf);
  ASSERT_EQ(corners.size(), 60000u);
  for (size_t i = 0; i < 30000; ++i) {
    ASSERT_EQ(corners[i][0], double(i));
    ASSERT_EQ(corners[30000 + i][0], double(29999 - i));
  }
}

TEST(Gltf, InterleavedVerticesAreReadWithTheirStride) {
  GltfBuilder gltf;
  const std::vector<float> vertices = {9, 0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0};  // one float, position
  const int view = gltf.view(vertices, 16);
  gltf.show(gltf.mesh(gltf.append("accessors", {{"bufferView", view},
                                                {"byteOffset", 4},
                                                {"componentType", 5126},
                                                {"count", 3},
                                                {"type", "VEC3"}})));
  EXPECT_EQ(read_corners(gltf), kTriangleCorners);
}

TEST(Gltf, QuantizedPositionsAreConvertedWithoutRounding) {
  GltfBuilder gltf;
  gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const auto read = [](const auto& values, bool normalized) {
    GltfBuilder g;
    g.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int accessor = g.accessor(values, "VEC3");
    g.json["accessors"][0]["normalized"] = normalized;
    g.show(g.mesh(accessor));
    return read_corners(g).front();
  };
  using P = std::array<double, 3>;
  EXPECT_EQ(read(std::vector<int8_t>{-128, 127, 5, 0, 0, 0, 0, 0, 0}, false), (P{-128, 127, 5}));
  EXPECT_EQ(read(std::vector<int8_t>{-128, 127, 5, 0, 0, 0, 0, 0, 0}, true), (P{-1, 1, 5 / 127.0}));
  EXPECT_EQ(read(std::vector<uint8_t>{0, 255, 5, 0, 0, 0, 0, 0, 0}, true), (P{0, 1, 5 / 255.0}));
  EXPECT_EQ(read(std::vector<uint16_t>{0, 65535, 5, 0, 0, 0, 0, 0, 0}, true),
            (P{0, 1, 5 / 65535.0}));
  EXPECT_EQ(read(std::vector<int16_t>{-32768, 32767, 5, 0, 0, 0, 0, 0, 0}, true),
            (P{-1, 1, 5 / 32767.0}));
  EXPECT_EQ(read(std::vector<int16_t>{-32768, 32767, 5, 0, 0, 0, 0, 0, 0}, false),
            (P{-32768, 32767, 5}));
}

TEST(Gltf, SparseAccessorsReplaceElements) {
  for (const bool based : {true, false}) {
    GltfBuilder gltf;
    json accessor = {{"componentType", 5126}, {"count", 6}, {"type", "VEC3"}};
    if (based) accessor["bufferView"] = gltf.view(std::vector<float>(18, 7));
    accessor["sparse"] = {
        {"count", 2},
        {"indices",
         {{"bufferView", gltf.view(std::vector<uint8_t>{1, 5})}, {"componentType", 5121}}},
        {"values", {{"bufferView", gltf.view(std::vector<float>{1, 2, 3, 4, 5, 6})}}}};
    gltf.show(gltf.mesh(gltf.append("accessors", accessor)));
    const double rest = based ? 7 : 0;
    const std::array<double, 3> r = {rest, rest, rest};
    EXPECT_EQ(read_corners(gltf), (CornerList{r, {1, 2, 3}, r, r, r, {4, 5, 6}}));
  }
}

TEST(Gltf, SparseIndicesMustIncrease) {
  GltfBuilder gltf;
  gltf.show(gltf.mesh(gltf.append(
      "accessors",
      {{"componentType", 5126},
       {"count", 3},
       {"type", "VEC3"},
       {"sparse",
        {{"count", 2},
         {"indices",
          {{"bufferView", gltf.view(std::vector<uint8_t>{1, 1})}, {"componentType", 5121}}},
         {"values", {{"bufferView", gltf.view(std::vector<float>{1, 2, 3, 4, 5, 6})}}}}}})));
  EXPECT_THAT(failure(gltf), HasSubstr("sparse"));
}

TEST(Gltf, AnAccessorWithoutDataIsZeros) {
  GltfBuilder gltf;
  gltf.show(gltf.mesh(
      gltf.append("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}})));
  EXPECT_EQ(read_corners(gltf), CornerList(3, {0, 0, 0}));
}

}  // namespace
}  // namespace svdag
