// The glTF node hierarchy: the world position of a mesh, and whether it is included.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/io/scene/gltf/gltf_builder.h"

namespace svdag {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;


// The triangle under one node of the given transform.
CornerList placed(const json& transform) {
  GltfBuilder gltf;
  json node = transform;
  node["mesh"] = gltf.mesh(gltf.accessor(kTriangle, "VEC3"));
  gltf.scene({gltf.append("nodes", node)});
  return read_corners(gltf);
}

TEST(GltfNodes, QuarterTurnsAreExact) {
  const double h = std::sqrt(0.5);
  EXPECT_EQ(placed({{"rotation", {0, 0, h, h}}}), (CornerList{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}}));
  EXPECT_EQ(placed({{"rotation", {h, 0, 0, h}}}), (CornerList{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}));
  EXPECT_EQ(placed({{"rotation", {0, h, 0, h}}}), (CornerList{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}}));
}

TEST(GltfNodes, QuaternionsOfAnyLengthAreRotations) {
  EXPECT_EQ(placed({{"rotation", {0, 0, 3, 3}}}), (CornerList{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}}));
  GltfBuilder gltf = one_triangle();
  gltf.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
  EXPECT_THAT(failure(gltf), HasSubstr("rotation"));
}

// A mirror, so two corners change places.
TEST(GltfNodes, ScaleThenRotationThenTranslation) {
  EXPECT_EQ(
      placed({{"scale", {2, -3, 1}}, {"rotation", {0, 0, 1, 1}}, {"translation", {10, 0, 5}}}),
      (CornerList{{10, 0, 5}, {13, 0, 5}, {10, 2, 5}}));
}

TEST(GltfNodes, MatricesAreColumnMajor) {
  EXPECT_EQ(placed({{"matrix", {2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1}}}),
            (CornerList{{10, 20, 30}, {12, 20, 30}, {10, 23, 30}}));
  GltfBuilder gltf = one_triangle();
  gltf.json["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_THAT(failure(gltf), HasSubstr("projection"));
  gltf.json["nodes"][0]["matrix"] = {1, 0, 0, 1e-17, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 0.9999999};
  EXPECT_EQ(read_corners(gltf), (CornerList{{5, 0, 0}, {6, 0, 0}, {5, 1, 0}}));  // noise
}

TEST(GltfNodes, ParentsApplyAfterChildren) {
  GltfBuilder gltf;
  const int mesh = gltf.mesh(gltf.accessor(kTriangle, "VEC3"));
  const int leaf = gltf.append("nodes", {{"mesh", mesh}, {"translation", {1, 0, 0}}});
  const int middle = gltf.append("nodes", {{"children", {leaf}}, {"rotation", {0, 0, 1, 1}}});
  const int root = gltf.append(
      "nodes",
      {{"children", {middle}}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 100, 0, 0, 1}}});
  gltf.scene({root});
  EXPECT_EQ(read_corners(gltf), (CornerList{{100, 2, 0}, {100, 4, 0}, {98, 2, 0}}));
}

TEST(GltfNodes, OneMeshMayStandUnderSeveralNodes) {
  GltfBuilder gltf;
  const int mesh = gltf.mesh(gltf.accessor(kTriangle, "VEC3"));
  gltf.scene({gltf.append("nodes", {{"mesh", mesh}, {"translation", {5, 0, 0}}}),
              gltf.append("nodes", {{"mesh", mesh}})});
  EXPECT_EQ(read_corners(gltf),
            (CornerList{{5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(GltfNodes, OnlyTheDefaultSceneIsDrawn) {
  GltfBuilder gltf;
  const int mesh = gltf.mesh(gltf.accessor(kTriangle, "VEC3"));
  for (const int x : {1, 2, 3}) {
    gltf.scene({gltf.append("nodes", {{"mesh", mesh}, {"translation", {x, 0, 0}}})});
  }
  gltf.json["scene"] = 1;
  EXPECT_EQ(read_corners(gltf).front()[0], 2);
  gltf.json.erase("scene");
  EXPECT_EQ(read_corners(gltf).front()[0], 1);
  gltf.json.erase("scenes");
  EXPECT_EQ(read_corners(gltf).size(), 9u);
}

TEST(GltfNodes, InstancesAreDrawnAtTheirTransforms) {
  for (const bool indexed : {false, true}) {
    GltfBuilder gltf;
    gltf.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const int positions = gltf.accessor(kTriangle, "VEC3");
    const int indices = indexed ? gltf.accessor(std::vector<uint8_t>{0, 1, 2}, "SCALAR") : -1;
    const json attributes = {
        {"TRANSLATION", gltf.accessor(std::vector<float>{1, 0, 0, 2, 0, 0}, "VEC3")},
        {"ROTATION", gltf.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1}, "VEC4")},
        {"SCALE", gltf.accessor(std::vector<float>{1, 1, 1, 4, 4, 4}, "VEC3")}};
    gltf.scene({gltf.append(
        "nodes", {{"mesh", gltf.mesh(positions, indices)},
                  {"translation", {0, 0, 9}},
                  {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}})});
    EXPECT_EQ(read_corners(gltf),
              (CornerList{{1, 0, 9}, {2, 0, 9}, {1, 1, 9}, {2, 0, 9}, {2, 4, 9}, {-2, 0, 9}}));
  }
}

// A triangle with EXT_mesh_gpu_instancing.
GltfBuilder instanced(GltfBuilder gltf, const json& attributes) {
  gltf.show(gltf.mesh(gltf.accessor(kTriangle, "VEC3")));
  gltf.json["nodes"][0]["extensions"] = {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}};
  return gltf;
}

TEST(GltfNodes, AnyAttributeSaysHowManyInstancesThereAre) {
  GltfBuilder gltf;
  const int ids = gltf.accessor(std::vector<uint16_t>{7, 8, 9}, "SCALAR");
  const int pairs = gltf.append("accessors", {{"bufferView", gltf.view(std::vector<float>(6))},
                                              {"componentType", 5126},
                                              {"count", 3},
                                              {"type", "VEC2"}});
  const CornerList one = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  CornerList three;
  for (int i = 0; i < 3; ++i) three.insert(three.end(), one.begin(), one.end());
  EXPECT_EQ(read_corners(instanced(gltf, {{"_ID", ids}})), three);
  EXPECT_EQ(read_corners(instanced(gltf, {{"_ID", ids}, {"_WIND", pairs}})), three);
  EXPECT_TRUE(read_corners(instanced(gltf, json::object())).empty());
}

TEST(GltfNodes, AttributesOfInstancesThatDisagreeAreAnError) {
  GltfBuilder gltf;
  const int ids = gltf.accessor(std::vector<uint16_t>{7, 8, 9}, "SCALAR");
  const int two = gltf.accessor(std::vector<float>{1, 0, 0, 2, 0, 0}, "VEC3");
  EXPECT_THAT(failure(instanced(gltf, {{"_ID", ids}, {"TRANSLATION", two}})),
              HasSubstr("different numbers"));
  EXPECT_THAT(failure(instanced(gltf, {{"SCALE", ids}})), HasSubstr("VEC3"));
  const json claimed = {{"componentType", 5121}, {"count", 1000}, {"type", "SCALAR"}};
  const int unbacked = gltf.append("accessors", claimed);
  EXPECT_THAT(failure(instanced(gltf, {{"_ID", unbacked}})), HasSubstr("without data"));
  gltf.json["accessors"][size_t(ids)]["type"] = "VEC9";
  EXPECT_THAT(failure(instanced(gltf, {{"_ID", ids}})), HasSubstr("unknown type"));
}

TEST(GltfNodes, CyclesAndSharedChildrenAreErrors) {
  GltfBuilder gltf = one_triangle();
  gltf.json["nodes"][0]["children"] = {0};
  EXPECT_THAT(failure(gltf), HasSubstr("nodes[0]"));
  gltf.json.erase("scenes");
  EXPECT_THAT(failure(gltf), HasSubstr("own ancestors"));
}

TEST(GltfNodes, AHierarchyTooDeepIsAnError) {
  GltfBuilder gltf;
  for (int i = 0; i < 5000; ++i) gltf.append("nodes", {{"children", {i + 1}}});
  gltf.append("nodes", json::object());
  gltf.scene({0});
  EXPECT_THAT(failure(gltf), HasSubstr("too deep"));
}

class GltfNames : public testing::Test {
 protected:
  // house { door, roof { tile } }, tree
  GltfNames() {
    const int mesh = gltf_.mesh(gltf_.accessor(kTriangle, "VEC3"));
    const auto node = [&](const char* name, const std::vector<int>& children) {
      json n = {{"name", name}, {"mesh", mesh}};
      if (!children.empty()) n["children"] = children;
      return gltf_.append("nodes", n);
    };
    const int roof = node("roof", {node("tile", {})});
    gltf_.scene({node("house", {node("door", {}), roof}), node("tree", {})});
  }
  std::vector<std::string> names(const NameFilter& filter) const {
    std::vector<std::string> names;
    read_corners(gltf_, filter, &names);
    return names;
  }
  GltfBuilder gltf_;
};

TEST_F(GltfNames, WithoutPatternsEverythingIsDrawnDepthFirst) {
  EXPECT_THAT(names({}), ElementsAre("house", "door", "roof", "tile", "tree"));
}

TEST_F(GltfNames, AChosenNodeBringsItsDescendants) {
  EXPECT_THAT(names({{"ro*"}, {}}), ElementsAre("roof", "tile"));
  EXPECT_THAT(names({{"house"}, {}}), ElementsAre("house", "door", "roof", "tile"));
}

TEST(GltfMaterials, SelectThePrimitivesOfAMesh) {
  GltfBuilder gltf = one_triangle();
  gltf.append("materials", {{"name", "brick"}});
  gltf.append("materials", {{"name", "glass"}});
  json& primitives = gltf.json["meshes"][0]["primitives"];
  const json primitive = primitives[0];
  primitives.push_back(primitive);
  primitives.push_back(primitive);  // without a material
  primitives[0]["material"] = 0;
  primitives[1]["material"] = 1;
  EXPECT_EQ(read_corners(gltf).size(), 9u);
  EXPECT_EQ(read_corners(gltf, {{"material:gl*"}, {}}).size(), 3u);
  EXPECT_EQ(read_corners(gltf, {{}, {"glass"}}).size(), 6u);
  EXPECT_EQ(read_corners(gltf, {{}, {"object:glass"}}).size(), 9u);
}

// "If the determinant of the transform is negative, the winding order is reversed" (section 3.7.4).
TEST(GltfNodes, AMirrorKeepsTheOutsideOutside) {
  GltfBuilder gltf = one_triangle();
  const CornerList plain = read_corners(gltf);
  gltf.json["nodes"][0]["scale"] = {-1, 1, 1};
  const CornerList mirrored = read_corners(gltf);
  ASSERT_EQ(mirrored.size(), 3u);
  for (const auto& [from, to] : {std::pair(0, 0), {1, 2}, {2, 1}})
    EXPECT_EQ(mirrored[size_t(to)][0], -plain[size_t(from)][0]);
  gltf.json["nodes"][0]["scale"] = {-1, -1, 1};
  EXPECT_EQ(read_corners(gltf)[1][0], -plain[1][0]);
}

TEST_F(GltfNames, AnExcludedNodeTakesItsDescendants) {
  EXPECT_THAT(names({{}, {"roof"}}), ElementsAre("house", "door", "tree"));
  EXPECT_THAT(names({{"tile"}, {"roof"}}), ElementsAre());
}

}  // namespace
}  // namespace svdag
