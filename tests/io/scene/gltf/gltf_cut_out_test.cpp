#include "io/scene/gltf/gltf_cut_out.h"

#include <gtest/gtest.h>

#include "tests/io/scene/gltf/gltf_builder.h"

namespace svdag {
namespace {

// Of a triangle of this mode with these colours of its vertices.
uint64_t meshes_of_vertex_alpha(const char* mode, const std::vector<float>& colours,
                                const char* type) {
  GltfBuilder gltf;
  const int mesh = gltf.mesh(gltf.accessor(kTriangle, "VEC3"));
  nlohmann::json& primitive = gltf.json["meshes"][size_t(mesh)]["primitives"][0];
  primitive["attributes"]["COLOR_0"] = gltf.accessor(colours, type);
  primitive["material"] = gltf.append("materials", {{"alphaMode", mode}});
  gltf.show(mesh);
  const TempFolder folder;
  const File file = File::open_read(folder.write("scene.glb", gltf.glb()));
  const NameFilter names;
  MemoryBudget budget;
  AlphaImages images(&budget, false);
  ReadOptions options{&names, false, &budget};
  options.alpha = &images;
  return read_meshes(read_gltf, file, options,
                     [](const TriangleBatch&) {})[size_t(Omission::kVertexAlpha)];
}

TEST(GltfCutOut, AlphaOfVerticesIsCountedWhereItCouldCut) {
  const std::vector<float> opaque = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::vector<float> clear = opaque;
  clear[7] = 0.75;
  EXPECT_EQ(meshes_of_vertex_alpha("MASK", clear, "VEC4"), 1U);
  EXPECT_EQ(meshes_of_vertex_alpha("MASK", opaque, "VEC4"), 0U);
  EXPECT_EQ(meshes_of_vertex_alpha("OPAQUE", clear, "VEC4"), 0U);
  EXPECT_EQ(meshes_of_vertex_alpha("MASK", {0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3"), 0U);
}

}  // namespace
}  // namespace svdag
