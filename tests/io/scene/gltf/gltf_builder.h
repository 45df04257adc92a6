// Builds small glTF and GLB files for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/scene/polygons/mesh_writer.h"
#include "streaming/error.h"
#include "tests/temp_folder.h"

namespace svdag {

// A glTF document under construction: one buffer, a view and an accessor for each array.
class GltfBuilder {
 public:
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  std::string bytes;

  template <class T>
  int view(const std::vector<T>& values, int stride = 0) {
    while (bytes.size() % 4 != 0) bytes += '\0';
    nlohmann::json view = {{"buffer", 0}, {"byteOffset", bytes.size()}};
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    view["byteLength"] = values.size() * sizeof(T);
    if (stride != 0) view["byteStride"] = stride;
    return append("bufferViews", view);
  }

  template <class T>
  int accessor(const std::vector<T>& values, const char* type) {
    const std::string name = type;
    const size_t width = name == "SCALAR" ? 1 : name == "VEC2" ? 2 : name == "VEC3" ? 3 : 4;
    return append("accessors", {{"bufferView", view(values)},
                                {"componentType", component_type<T>()},
                                {"count", values.size() / width},
                                {"type", type}});
  }

  int append(const char* key, const nlohmann::json& value) {
    json[key].push_back(value);
    return int(json[key].size()) - 1;
  }

  // A mesh of one primitive; indices < 0: none.
  int mesh(int positions, int indices = -1, int mode = 4) {
    nlohmann::json primitive = {{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
    if (indices >= 0) primitive["indices"] = indices;
    return append("meshes", {{"primitives", {primitive}}});
  }

  void scene(const std::vector<int>& roots) { append("scenes", {{"nodes", roots}}); }

  // A scene of one node with the mesh.
  void show(int mesh_index) { scene({append("nodes", {{"name", "only"}, {"mesh", mesh_index}})}); }

  std::string text(const std::string& uri) const {
    nlohmann::json copy = json;
    copy["buffers"] = {{{"byteLength", bytes.size()}, {"uri", uri}}};
    return copy.dump();
  }

  std::string glb() const {
    nlohmann::json copy = json;
    copy["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string document = copy.dump();
    document.resize((document.size() + 3) / 4 * 4, ' ');
    std::string binary = bytes;
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const size_t total = 12 + 8 + document.size() + 8 + binary.size();
    return "glTF" + u32(2) + u32(total) + u32(document.size()) + "JSON" + document +
           u32(binary.size()) + std::string("BIN\0", 4) + binary;
  }

  static std::string u32(size_t value) {
    const uint32_t v = uint32_t(value);
    return std::string(reinterpret_cast<const char*>(&v), 4);
  }

 private:
  template <class T>
  static int component_type() {
    if (std::is_same_v<T, float>) return 5126;
    return std::is_signed_v<T> ? (sizeof(T) == 1 ? 5120 : 5122)
                               : (sizeof(T) == 1   ? 5121
                                  : sizeof(T) == 2 ? 5123
                                                   : 5125);
  }
};

using CornerList = std::vector<std::array<double, 3>>;

// All corners of a file, three per triangle; `names` collects the mesh names.
inline CornerList read_corners(const std::string& path, const NameFilter& filter = {},
                               std::vector<std::string>* names = nullptr) {
  MemoryBudget budget;
  CornerList corners;
  const File file = File::open_read(path);
  read_meshes(read_gltf, file, {&filter, false, &budget}, [&](const TriangleBatch& batch) {
    if (names != nullptr) names->push_back(std::string(batch.mesh));
    for (const Triangle& t : batch.triangles) {
      for (const Point& p : t.v) corners.push_back({p.x, p.y, p.z});
    }
  });
  EXPECT_EQ(budget.used(), 0u);
  return corners;
}

inline CornerList read_corners(const GltfBuilder& gltf, const NameFilter& filter = {},
                               std::vector<std::string>* names = nullptr) {
  const TempFolder folder;
  return read_corners(folder.write("scene.glb", gltf.glb()), filter, names);
}

// The sentence of the Error that reading `path` must end in.
inline std::string failure(const std::string& path) {
  try {
    read_corners(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

inline std::string failure(const GltfBuilder& gltf) {
  const TempFolder folder;
  return failure(folder.write("scene.glb", gltf.glb()));
}

inline const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

inline GltfBuilder one_triangle() {
  GltfBuilder gltf;
  gltf.show(gltf.mesh(gltf.accessor(kTriangle, "VEC3")));
  return gltf;
}

}  // namespace svdag
