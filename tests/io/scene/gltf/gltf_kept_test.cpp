// Primitives that several nodes share are decoded once, with the same result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/io/scene/gltf/gltf_builder.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

constexpr int kNodes = 5;

// One mesh of `vertices` vertices under five nodes: the same mesh for all, or a copy for each.
GltfBuilder scene_of(int vertices, int mode, bool shared) {
  std::mt19937 random(unsigned(vertices + mode));
  std::uniform_real_distribution<float> coordinate(-3, 3);
  std::vector<float> positions(size_t(3 * vertices));
  for (float& x : positions) x = coordinate(random);
  std::vector<uint16_t> indices(size_t(3 * vertices));
  for (uint16_t& i : indices) i = uint16_t(random() % unsigned(vertices));
  GltfBuilder gltf;
  const int position = gltf.accessor(positions, "VEC3"), index = gltf.accessor(indices, "SCALAR");
  std::vector<int> roots;
  for (int node = 0; node < kNodes; ++node) {
    const int mesh = shared && node > 0 ? 0 : gltf.mesh(position, index, mode);
    roots.push_back(gltf.append("nodes", {{"mesh", mesh},
                                          {"name", "n" + std::to_string(node)},
                                          {"translation", {node, 0.25 * node, -3}},
                                          {"rotation", {0.1, 0.2, 0.3, 0.4 + node}}}));
  }
  gltf.scene(roots);
  return gltf;
}

TEST(GltfKept, ASharedMeshIsDrawnAsItsCopiesAre) {
  for (const int vertices : {3, 50, 60000}) {  // the last is too large to be kept
    for (const int mode : {4, 5, 6}) {
      std::vector<std::string> names, expected_names;
      const CornerList found = read_corners(scene_of(vertices, mode, true), {}, &names);
      EXPECT_GT(found.size(), 0U);
      EXPECT_EQ(found, read_corners(scene_of(vertices, mode, false), {}, &expected_names));
      EXPECT_EQ(names, expected_names);
    }
  }
}

TEST(GltfKept, InstancesOfASharedMeshAreAllDrawn) {
  const std::vector<float> shifts = {0, 0, 0, 1, 2, 3, 4, 5, 6};
  const auto instanced = [&](bool shared) {
    GltfBuilder gltf = scene_of(30, 4, shared);
    const int translation = gltf.accessor(shifts, "VEC3");
    for (auto& node : gltf.json["nodes"])
      node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = translation;
    return read_corners(gltf);
  };
  EXPECT_EQ(instanced(true).size(), 3U * 30 * 3 * kNodes);
  EXPECT_EQ(instanced(true), instanced(false));
}

TEST(GltfKept, LittleMemoryKeepsNothing) {
  const TempFolder folder;
  const std::string path = folder.write("scene.glb", scene_of(50, 4, true).glb());
  const auto peak = [&](uint64_t limit) {
    MemoryBudget budget(limit);
    const NameFilter all;
    read_meshes(read_gltf, File::open_read(path), {&all, false, &budget},
                [](const TriangleBatch&) {});
    EXPECT_EQ(budget.used(), 0U);
    return budget.peak();
  };
  const uint64_t unlimited = peak(MemoryBudget::kUnlimited);
  EXPECT_LT(peak(64 * 1024), unlimited);
}

}  // namespace
}  // namespace svdag
