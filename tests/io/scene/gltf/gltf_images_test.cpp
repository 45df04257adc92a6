// Colours of glTF materials: factors times the means of textures, wherever the images are.
#include <gtest/gtest.h>

#include "io/scene/decoders/image.h"
#include "io/scene/scene.h"
#include "tests/io/scene/gltf/gltf_builder.h"
#include "tests/io/scene/png_file.h"

namespace svdag {
namespace {

using nlohmann::json;

// In digits and '+', '/', as of data URIs.
std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
    for (int k = 18; k >= 0; k -= 6) text += digits[bits >> k & 63];
  }
  const size_t padding = (3 - bytes.size() % 3) % 3;
  return text.substr(0, text.size() - padding) + std::string(padding, '=');
}

class GltfImages : public testing::Test {
 protected:
  GltfImages() {
    const int positions = gltf_.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    gltf_.show(gltf_.mesh(positions));
    gltf_.json["meshes"][0]["primitives"][0]["material"] = 0;
    gltf_.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    gltf_.json["textures"] = {{{"source", 0}}};
  }

  void image(const json& image) { gltf_.json["images"] = {image}; }
  json& pbr() { return gltf_.json["materials"][0]["pbrMetallicRoughness"]; }

  std::optional<Colour> colour(bool wanted = true) {
    SceneConfig config;
    config.paths = {folder_.write("s.glb", gltf_.glb())};
    config.colours = wanted;
    std::optional<Colour> colour;
    {
      const Scene scene(config, &budget_);
      scene.bounds();  // a second pass takes the same images
      notes_ =
          scene.stream([&](const TriangleBatch& batch) { colour = batch.colour; }).unread_images;
      files_.clear();
      scene.visit_files([&](const File& file) {
        files_.push_back(std::filesystem::path(file.path()).filename().string());
      });
    }
    EXPECT_EQ(budget_.used(), 0u);
    return colour;
  }

  GltfBuilder gltf_;
  TempFolder folder_;
  MemoryBudget budget_;
  std::vector<std::string> notes_, files_;
};

// Section 3.9.6 of glTF 2.0: alpha is ignored unless the mode is MASK or BLEND.
TEST_F(GltfImages, AlphaIsIgnoredInOpaqueMaterials) {
  const std::string red = rgb(255, 0, 0), green = rgb(0, 255, 0);
  const std::string bytes = png(2, 1, PngKind::kRgba, red + '\xff' + green + '\0');
  image({{"bufferView", gltf_.view(std::vector<char>(bytes.begin(), bytes.end()))},
         {"mimeType", "image/png"}});
  EXPECT_EQ(colour(), (Colour{188, 188, 0}));
  gltf_.json["materials"][0]["alphaMode"] = "OPAQUE";
  EXPECT_EQ(colour(), (Colour{188, 188, 0}));
  gltf_.json["materials"][0]["alphaMode"] = "BLEND";
  EXPECT_EQ(colour(), (Colour{255, 0, 0}));
}

TEST_F(GltfImages, AnImageInABufferView) {
  const std::string bytes = one_texel(10, 20, 30);
  image({{"bufferView", gltf_.view(std::vector<char>(bytes.begin(), bytes.end()))},
         {"mimeType", "image/png"}});
  EXPECT_EQ(colour(), (Colour{10, 20, 30}));
  EXPECT_TRUE(notes_.empty());
}

TEST_F(GltfImages, AnImageInADataUri) {
  image({{"uri", "data:image/png;base64," + base64(one_texel(10, 20, 30))}});
  EXPECT_EQ(colour(), (Colour{10, 20, 30}));
  EXPECT_EQ(files_, (std::vector<std::string>{"s.glb"}));
}

TEST_F(GltfImages, AnImageBesideTheFileIsAnInput) {
  folder_.write("red wood.png", one_texel(10, 20, 30));
  for (const char* uri : {"red%20wood.png", "red wood.png"}) {
    image({{"uri", uri}});
    EXPECT_EQ(colour(), (Colour{10, 20, 30}));
    EXPECT_EQ(files_, (std::vector<std::string>{"s.glb", "red wood.png"}));
  }
}

TEST_F(GltfImages, WithoutColoursNoImageIsReadOrAnInput) {
  folder_.write("broken.png", "");
  image({{"uri", "broken.png"}});
  EXPECT_EQ(colour(false), std::nullopt);
  EXPECT_TRUE(notes_.empty());
  EXPECT_EQ(files_, (std::vector<std::string>{"s.glb"}));
}

TEST_F(GltfImages, TheFactorIsLinearLight) {
  folder_.write("grey.png", one_texel(188, 188, 255));
  image({{"uri", "grey.png"}});
  pbr()["baseColorFactor"] = {0.5, 1, 0.5, 1};
  EXPECT_EQ(colour(), (Colour{137, 188, 188}));
  pbr().erase("baseColorTexture");
  EXPECT_EQ(colour(), (Colour{188, 255, 188}));
}

// The left half of the image is red, the right one green.
TEST_F(GltfImages, OnlyThePartOfTheImageThatTrianglesUseCounts) {
  std::string texels;
  for (int i = 0; i < 64; ++i) texels += i % 8 < 4 ? rgb(255, 0, 0) : rgb(0, 255, 0);
  folder_.write("halves.png", png(8, 8, PngKind::kRgb, texels));
  image({{"uri", "halves.png"}});
  EXPECT_EQ(colour(), (Colour{188, 188, 0}));
  const int left = gltf_.accessor(std::vector<float>{0.1f, 0.1f, 0.4f, 0.1f, 0.1f, 0.5f}, "VEC2");
  const int right = gltf_.accessor(std::vector<float>{0.9f, 0, 0.6f, 0, 0.6f, 0.5f}, "VEC2");
  json& primitive = gltf_.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = left;
  EXPECT_EQ(colour(), (Colour{255, 0, 0}));
  // What other primitives of the material use counts as well.
  json other = primitive;
  other["attributes"]["TEXCOORD_0"] = right;
  gltf_.json["meshes"][0]["primitives"].push_back(other);
  const std::optional<Colour> both = colour();
  EXPECT_GT(both->r, 160);
  EXPECT_GT(both->g, 160);
  // A list of another length is a note: the triangles do not need it.
  gltf_.json["meshes"][0]["primitives"].erase(1);
  gltf_.json["meshes"][0]["primitives"][0]["indices"] =
      gltf_.accessor(std::vector<uint16_t>{0, 1, 2}, "SCALAR");
  gltf_.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      gltf_.accessor(std::vector<float>{0.9f, 0}, "VEC2");
  EXPECT_EQ(colour(), (Colour{188, 188, 0}));
  EXPECT_EQ(notes_.size(), 1u);
}

TEST_F(GltfImages, AMaterialWithoutFactorAndTextureHasNoColour) {
  pbr().erase("baseColorTexture");
  EXPECT_EQ(colour(), std::nullopt);
  pbr()["metallicFactor"] = 0;
  EXPECT_EQ(colour(), std::nullopt);
  gltf_.json["materials"][0] = {{"name", "plain"}};
  EXPECT_EQ(colour(), std::nullopt);
}

TEST_F(GltfImages, AnImageThatCannotBeReadLeavesTheFactorAndOneNote) {
  folder_.write("broken.png", "nothing");
  const std::string scene = folder_.file("s.glb");
  const std::vector<std::pair<json, std::string>> cases = {
      {{{"uri", "missing.png"}},
       scene + ": refers to the image \"missing.png\", which does not exist"},
      {{{"uri", "../outside.png"}},
       scene + ": refers to the image \"../outside.png\", but it must be a file in the scene's "
               "folder"},
      {{{"uri", "broken.png"}},
       scene + ": images[0]: is not a readable PNG or JPEG image: unknown image type"},
      {{{"uri", "data:image/png;base64,AAAA"}},
       scene + ": images[0]: is not a readable PNG or JPEG image: unknown image type"},
      {{{"uri", "data:image/png,AAAA"}},
       scene + ": has a data URI that is not base64: \"data:image/png,AAAA\""},
      {{{"bufferView", 7}}, scene + ": refers to bufferViews[7], but has only 1"},
      {json::object(), scene + ": has broken glTF JSON: \"bufferView\" is missing"}};
  for (const auto& [value, note] : cases) {
    image(value);
    pbr().erase("baseColorFactor");
    EXPECT_EQ(colour(), std::nullopt) << note;
    pbr()["baseColorFactor"] = {0, 1, 0, 1};
    EXPECT_EQ(colour(), (Colour{0, 255, 0})) << note;
    EXPECT_EQ(notes_, std::vector<std::string>{note});
  }
}

TEST_F(GltfImages, ATextureOfAnExtensionOrThatDoesNotExistIsANote) {
  for (const json& textures :
       {json(), json{{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}}}) {
    gltf_.json["textures"] = textures;
    if (textures.is_null()) gltf_.json.erase("textures");
    EXPECT_EQ(colour(), std::nullopt);
    EXPECT_EQ(notes_, std::vector<std::string>{folder_.file("s.glb") +
                                               ": textures[0]: has no PNG or JPEG image"});
  }
}

TEST_F(GltfImages, AnImageOfSeveralTexturesHasOneNote) {
  image({{"uri", "missing.png"}});
  gltf_.json["textures"].push_back({{"source", 0}});
  json material = gltf_.json["materials"][0];
  material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
  gltf_.json["materials"].push_back(material);
  json primitive = gltf_.json["meshes"][0]["primitives"][0];
  primitive["material"] = 1;
  gltf_.json["meshes"][0]["primitives"].push_back(primitive);
  colour();
  EXPECT_EQ(notes_.size(), 1u);
}

}  // namespace
}  // namespace svdag
