// GLB files with textures and colours of vertices, for tests of colours.
#pragma once

#include <array>
#include <random>
#include <string>
#include <vector>

#include "io/triangle.h"
#include "tests/io/scene/gltf/gltf_builder.h"
#include "tests/io/scene/png_file.h"

namespace svdag {

struct TestTriangle {
  Triangle triangle;
  std::array<std::array<float, 2>, 3> texture = {};
  std::array<std::array<float, 3>, 3> colour = {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};
};

// A primitive for each material, which has a factor, and a texture, colours or both.
class PaintedGlb {
 public:
  nlohmann::json material(std::array<double, 3> factor, int texture = -1) {
    nlohmann::json pbr = {{"baseColorFactor", {factor[0], factor[1], factor[2], 1.0}}};
    if (texture >= 0) pbr["baseColorTexture"] = {{"index", texture}};
    return {{"pbrMetallicRoughness", pbr}};
  }
  // Returns the number of a texture of these bytes (RGBA).
  int texture(uint32_t width, uint32_t height, const std::string& rgba,
              const nlohmann::json& sampler = nlohmann::json::object()) {
    const std::string file = png(width, height, PngKind::kRgba, rgba);
    const int image = gltf_.append(
        "images", {{"bufferView", gltf_.view(std::vector<char>(file.begin(), file.end()))},
                   {"mimeType", "image/png"}});
    return gltf_.append("textures",
                        {{"source", image}, {"sampler", gltf_.append("samplers", sampler)}});
  }
  void add(const nlohmann::json& material, const std::vector<TestTriangle>& triangles,
           bool with_colours) {
    std::vector<float> positions, points, colours;
    for (const TestTriangle& t : triangles) {
      for (size_t k = 0; k < 3; ++k) {
        for (int a = 0; a < 3; ++a) positions.push_back(float(t.triangle.v[k][a]));
        points.insert(points.end(), t.texture[k].begin(), t.texture[k].end());
        colours.insert(colours.end(), t.colour[k].begin(), t.colour[k].end());
      }
    }
    nlohmann::json attributes = {{"POSITION", gltf_.accessor(positions, "VEC3")},
                                 {"TEXCOORD_0", pairs(points)}};
    if (with_colours) attributes["COLOR_0"] = gltf_.accessor(colours, "VEC3");
    const int mesh = gltf_.append(
        "meshes",
        {{"primitives",
          {{{"attributes", attributes}, {"material", gltf_.append("materials", material)}}}}});
    roots_.push_back(gltf_.append("nodes", {{"mesh", mesh}}));
  }
  std::string bytes() {
    GltfBuilder whole = gltf_;
    whole.scene(roots_);
    return whole.glb();
  }

 private:
  int pairs(const std::vector<float>& values) {
    return gltf_.append("accessors", {{"bufferView", gltf_.view(values)},
                                      {"componentType", 5126},
                                      {"count", values.size() / 2},
                                      {"type", "VEC2"}});
  }

  GltfBuilder gltf_;
  std::vector<int> roots_;
};

}  // namespace svdag
