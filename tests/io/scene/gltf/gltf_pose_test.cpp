// Skins and morph targets at rest: by the formulas of the specification, written out here.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "io/scene/scene.h"
#include "tests/io/scene/gltf/gltf_builder.h"

namespace svdag {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// Column by column: moves by (x, y, z), and scales by s.
std::vector<float> moving(float x, float y, float z, float s = 1) {
  return {s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0, x, y, z, 1};
}
std::vector<float> joined(std::initializer_list<std::vector<float>> parts) {
  std::vector<float> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// A triangle with two joints: node 1 at (10, 0, 0), below it node 2 at (0, 20, 0) from there.
class Skinned : public testing::Test {
 protected:
  Skinned() {
    mesh_ = gltf_.mesh(gltf_.accessor(kTriangle, "VEC3"));
    gltf_.append("nodes", {{"mesh", mesh_}, {"skin", 0}, {"translation", {100, 100, 100}}});
    gltf_.append("nodes", {{"translation", {10, 0, 0}}, {"children", {2}}});
    gltf_.append("nodes", {{"translation", {0, 20, 0}}});
    gltf_.append("skins", {{"joints", {1, 2}}});
    gltf_.scene({0, 1});
  }
  json& primitive() { return gltf_.json["meshes"][size_t(mesh_)]["primitives"][0]; }
  template <class T>
  void weigh(const std::vector<T>& joints, const std::vector<float>& weights, int set = 0) {
    primitive()["attributes"]["JOINTS_" + std::to_string(set)] = gltf_.accessor(joints, "VEC4");
    primitive()["attributes"]["WEIGHTS_" + std::to_string(set)] = gltf_.accessor(weights, "VEC4");
  }
  void bind(const std::vector<float>& matrices) {
    gltf_.json["skins"][0]["inverseBindMatrices"] = gltf_.append(
        "accessors", {{"bufferView", gltf_.view(matrices)}, {"componentType", 5126},
                      {"count", matrices.size() / 16}, {"type", "MAT4"}});
  }
  // Each vertex to the first joint, then the second, then half to each.
  void weigh_usually() {
    weigh<uint8_t>({0, 0, 0, 0, 1, 9, 0, 0, 0, 1, 0, 0}, {1, 0, 0, 0, 2, 0, 0, 0, 3, 3, 0, 0});
  }

  GltfBuilder gltf_;
  int mesh_ = 0;
};

const CornerList kUsual = {{10, 0, 0}, {11, 20, 0}, {10, 11, 0}};

// The node's own transform does not count, and weights are divided by their sum.
TEST_F(Skinned, VerticesFollowTheirJoints) {
  weigh_usually();
  EXPECT_EQ(read_corners(gltf_), kUsual);
}

TEST_F(Skinned, JointsOfAnyComponentTypeAndSet) {
  weigh<uint16_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, .5f, 0, 0, 0});
  weigh<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, .5f}, 1);
  EXPECT_EQ(read_corners(gltf_), kUsual);
}

TEST_F(Skinned, InverseBindMatricesComeFirst) {
  weigh_usually();
  bind(joined({moving(1, 2, 3, 2), moving(0, 0, 0)}));
  EXPECT_EQ(read_corners(gltf_), (CornerList{{11, 2, 3}, {11, 20, 0}, {10.5, 12.5, 1.5}}));
}

TEST_F(Skinned, JointsCountOutsideTheSceneExcludedAndHidden) {
  weigh_usually();
  gltf_.json["nodes"][1]["extensions"]["KHR_node_visibility"] = {{"visible", false}};
  EXPECT_EQ(read_corners(gltf_), kUsual);
  gltf_.json["scenes"][0]["nodes"] = {0};
  EXPECT_EQ(read_corners(gltf_), kUsual);
  gltf_.json["nodes"][2]["name"] = "arm";
  NameFilter filter;
  filter.exclude = {"arm"};
  EXPECT_EQ(read_corners(gltf_, filter), kUsual);
}

// A skinned mesh is in the world, once for each node that draws it.
TEST_F(Skinned, IsNotMirroredInstancedOrShared) {
  weigh_usually();
  gltf_.json["nodes"][0]["scale"] = {-1, 1, 1};
  const int places = gltf_.accessor(std::vector<float>{0, 0, 0, 5, 5, 5}, "VEC3");
  gltf_.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", places}};
  EXPECT_EQ(read_corners(gltf_), kUsual);
  gltf_.json["scenes"][0]["nodes"].push_back(
      gltf_.append("nodes", {{"mesh", mesh_}, {"translation", {1, 1, 1}}}));
  CornerList both = kUsual;
  for (const auto& corner : CornerList{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}}) both.push_back(corner);
  EXPECT_EQ(read_corners(gltf_), both) << "the second node has no skin";
}

TEST_F(Skinned, VerticesWithoutWeightsArePlacedByTheirNode) {
  weigh<uint8_t>(std::vector<uint8_t>(12), {1, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0});
  const TempFolder folder;
  MemoryBudget budget;
  const Scene scene({.paths = {folder.write("a.glb", gltf_.glb())}, .names = {}}, &budget);
  CornerList corners;
  const SceneCounts counts = scene.stream([&](const TriangleBatch& batch) {
    for (const Point& p : batch.triangles[0].v) corners.push_back({p.x, p.y, p.z});
  });
  EXPECT_EQ(corners, (CornerList{{10, 0, 0}, {101, 100, 100}, {100, 101, 100}}));
  EXPECT_EQ(counts.left_out[size_t(Omission::kUnweighted)], 2U);
  EXPECT_EQ(counts.undeformed, 0U);
}

TEST_F(Skinned, BrokenSkinsAreRefused) {
  weigh<uint8_t>({0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  EXPECT_THAT(failure(gltf_), HasSubstr("joint 2 in a skin of only 2"));
  weigh_usually();
  bind(moving(0, 0, 0));
  EXPECT_THAT(failure(gltf_), HasSubstr("2 joints with only 1 inverse bind matrices"));
  gltf_.json["skins"][0].erase("inverseBindMatrices");
  gltf_.json["skins"][0]["joints"] = {1, 7};
  EXPECT_THAT(failure(gltf_), HasSubstr("nodes[7]"));
  gltf_.json["skins"][0]["joints"] = {1, 3};
  gltf_.append("nodes", {{"children", {3}}});
  EXPECT_THAT(failure(gltf_), HasSubstr("too deep"));
  gltf_.json["skins"][0]["joints"] = {1, 2};
  primitive()["attributes"].erase("WEIGHTS_0");
  EXPECT_THAT(failure(gltf_), HasSubstr("WEIGHTS_0"));
  weigh<uint8_t>({0, 0, 0, 0}, {1, 0, 0, 0});
  EXPECT_THAT(failure(gltf_), HasSubstr("differ in their number"));
  gltf_.json["nodes"][0]["skin"] = 4;
  weigh_usually();
  EXPECT_THAT(failure(gltf_), HasSubstr("skins[4]"));
}

TEST(Morph, TargetsAreAddedByWeight) {
  for (const bool indexed : {false, true}) {
    GltfBuilder gltf;
    const int positions = gltf.accessor(kTriangle, "VEC3");
    const int indices = indexed ? gltf.accessor(std::vector<uint16_t>{2, 0, 1}, "SCALAR") : -1;
    const int mesh = gltf.mesh(positions, indices);
    const int up = gltf.accessor(std::vector<float>{0, 0, 1, 0, 0, 2, 0, 0, 4}, "VEC3");
    // Only the second vertex moves.
    const int sparse = gltf.append(
        "accessors",
        {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"},
         {"sparse",
          {{"count", 1},
           {"indices", {{"bufferView", gltf.view(std::vector<uint16_t>{1})}, {"componentType", 5123}}},
           {"values", {{"bufferView", gltf.view(std::vector<float>{0, 8, 0})}}}}}});
    json& primitive = gltf.json["meshes"][size_t(mesh)]["primitives"][0];
    primitive["targets"] = {{{"POSITION", up}}, {{"NORMAL", up}}, {{"POSITION", sparse}}};
    gltf.show(mesh);
    const auto read = [&] {
      CornerList corners = read_corners(gltf);
      if (indexed) std::rotate(corners.begin(), corners.begin() + 1, corners.end());
      return corners;
    };
    EXPECT_EQ(read(), (CornerList{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << "weights are 0";
    gltf.json["meshes"][0]["weights"] = {0.5, 1, 0};
    EXPECT_EQ(read(), (CornerList{{0, 0, .5}, {1, 0, 1}, {0, 1, 2}}));
    gltf.json["nodes"][0]["weights"] = {-1, 0, 0.25};
    gltf.json["nodes"][0]["translation"] = {0, 0, 100};
    EXPECT_EQ(read(), (CornerList{{0, 0, 99}, {1, 2, 98}, {0, 1, 96}})) << "the node's weights";
    gltf.json["nodes"][0]["weights"] = {0, 1};
    EXPECT_EQ(read(), (CornerList{{0, 0, 100}, {1, 0, 100}, {0, 1, 100}})) << "normals do not move";
  }
}

// Many vertices, sets and targets, against sums in long double.
TEST(Pose, RandomMeshesAgreeWithPlainSums) {
  std::mt19937_64 random(7);
  const auto number = [&] { return float(int(random() % 2001) - 1000) / 64; };
  for (int round = 0; round < 8; ++round) {
    const size_t count = 3 * (1 + random() % 700), joints = 1 + random() % 5;
    GltfBuilder gltf;
    std::vector<float> positions, target, weights;
    std::vector<uint16_t> numbers;
    for (size_t i = 0; i < 3 * count; ++i) {
      positions.push_back(number());
      target.push_back(number());
    }
    for (size_t i = 0; i < 4 * count; ++i) {
      weights.push_back(float(1 + random() % 16) / 16);
      numbers.push_back(uint16_t(random() % joints));
    }
    const int mesh = gltf.mesh(gltf.accessor(positions, "VEC3"));
    json& primitive = gltf.json["meshes"][size_t(mesh)]["primitives"][0];
    primitive["attributes"]["JOINTS_0"] = gltf.accessor(numbers, "VEC4");
    primitive["attributes"]["WEIGHTS_0"] = gltf.accessor(weights, "VEC4");
    primitive["targets"] = {{{"POSITION", gltf.accessor(target, "VEC3")}}};
    gltf.json["meshes"][size_t(mesh)]["weights"] = {0.75};
    std::vector<std::array<float, 3>> moves;
    json list = json::array();
    for (size_t j = 0; j < joints; ++j) {
      moves.push_back({number(), number(), number()});
      list.push_back(gltf.append("nodes", {{"translation", moves.back()}, {"scale", {2, 1, 0.5}}}));
    }
    gltf.append("skins", {{"joints", list}});
    gltf.scene({gltf.append("nodes", {{"mesh", mesh}, {"skin", 0}})});
    const CornerList corners = read_corners(gltf);
    ASSERT_EQ(corners.size(), count);
    constexpr double kScale[3] = {2, 1, 0.5};
    for (size_t i = 0; i < count; ++i) {
      long double sum[3] = {0, 0, 0}, total = 0;
      for (size_t k = 4 * i; k < 4 * i + 4; ++k) {
        for (size_t a = 0; a < 3; ++a) {
          const long double p = positions[3 * i + a] + 0.75L * target[3 * i + a];
          sum[a] += weights[k] * (p * kScale[a] + moves[numbers[k]][a]);
        }
        total += weights[k];
      }
      for (size_t a = 0; a < 3; ++a) ASSERT_NEAR(corners[i][a], double(sum[a] / total), 1e-12);
    }
  }
}

}  // namespace
}  // namespace svdag
