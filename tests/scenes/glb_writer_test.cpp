// The GLB of a generated scene: every feature of a material is there, every index is valid.
#include "tests/scenes/glb_writer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/expect_error.h"
#include "tests/scenes/kinds.h"
#include "tests/temp_folder.h"

namespace svdag::scenes {
namespace {

using Json = nlohmann::json;

struct Glb {
  Json json;
  std::string bytes;  // of its buffer

  // Component k of element i of an accessor.
  template <class T>
  T at(const Json& number, uint64_t i, size_t k) const {
    const Json& accessor = json["accessors"].at(number.get<size_t>());
    const Json& view = json["bufferViews"].at(accessor["bufferView"].get<size_t>());
    const size_t width = view.value("byteStride", sizeof(T) * components(accessor));
    T value;
    const size_t begin = view["byteOffset"].get<size_t>() + accessor.value("byteOffset", size_t(0));
    std::memcpy(&value, &bytes.at(begin + i * width + k * sizeof value), sizeof value);
    return value;
  }
  static size_t components(const Json& accessor) {
    const std::string type = accessor["type"];
    return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : size_t(type.back() - '0');
  }
  uint64_t count(const Json& number) const {
    return json["accessors"].at(number.get<size_t>())["count"];
  }
};

std::string file_of(const std::string& kind, uint64_t triangles) {
  const TempFolder folder;
  write_glb(*make_scene(kind, triangles, 1), {}, folder.file("a.glb"));
  return folder.read("a.glb");
}

Glb parsed(const std::string& file) {
  uint32_t head[5];
  std::memcpy(head, file.data(), sizeof head);
  EXPECT_EQ(head[2], file.size());
  return {Json::parse(file.substr(20, head[3])), file.substr(28 + head[3])};
}

TEST(Glb, OfTheAtriumIsTheSameTwice) {
  EXPECT_EQ(file_of("atrium", 90'000), file_of("atrium", 90'000));
}

TEST(Glb, OfTheAtriumHasEveryFeatureOfAMaterial) {
  const Glb glb = parsed(file_of("atrium", 90'000));
  std::set<std::string> found;
  for (const Json& image : glb.json["images"]) found.insert(image["mimeType"]);
  for (const Json& sampler : glb.json["samplers"])
    found.insert("wrap " + std::to_string(sampler["wrapS"].get<int>()));
  for (const Json& material : glb.json["materials"]) {
    found.insert(material.value("alphaMode", "OPAQUE"));
    const Json& base = material["pbrMetallicRoughness"];
    if (base["baseColorFactor"][0] != 1) found.insert("factor");
    if (!base.contains("baseColorTexture")) found.insert("no texture");
  }
  for (const Json& mesh : glb.json["meshes"]) {
    for (const Json& primitive : mesh["primitives"]) {
      const Json& base =
          glb.json["materials"][primitive["material"].get<size_t>()]["pbrMetallicRoughness"];
      if (base.contains("baseColorTexture")) {
        const int set = base["baseColorTexture"].value("texCoord", 0);
        found.insert("set " + std::to_string(set));
        EXPECT_TRUE(primitive["attributes"].contains("TEXCOORD_" + std::to_string(set)));
      }
      if (primitive["attributes"].contains("COLOR_0")) found.insert("colours of vertices");
    }
  }
  EXPECT_EQ(found, (std::set<std::string>{"MASK", "OPAQUE", "colours of vertices", "factor",
                                          "image/jpeg", "image/png", "no texture", "set 0", "set 1",
                                          "wrap 10497", "wrap 33071", "wrap 33648"}));
}

TEST(Glb, HoldsTheTrianglesOfTheMesh) {
  const auto mesh = make_scene("atrium", 90'000, 1);
  const Glb glb = parsed(file_of("atrium", 90'000));
  std::multiset<std::array<float, 9>> in_file, in_mesh;
  for (const Json& object : glb.json["meshes"]) {
    for (const Json& primitive : object["primitives"]) {
      const Json &indices = primitive["indices"], &points = primitive["attributes"]["POSITION"];
      for (uint64_t i = 0; i < glb.count(indices); i += 3) {
        std::array<float, 9> t;
        for (size_t k = 0; k < 9; ++k) {
          const uint32_t corner = glb.at<uint32_t>(indices, i + k / 3, 0);
          ASSERT_LT(corner, glb.count(points));
          t[k] = glb.at<float>(points, corner, k % 3);
        }
        in_file.insert(t);
      }
    }
  }
  for (uint64_t i = 0; i < mesh->faces(); ++i) {
    std::array<float, 9> t;
    for (size_t k = 0; k < 9; ++k)
      t[k] = float(placed(*mesh, {}, mesh->face(i)[k / 3])[int(k % 3)]);
    in_mesh.insert(t);
  }
  EXPECT_TRUE(in_file == in_mesh);
}

TEST(Glb, OfTheFigureHasWeightsThatSumToOneAndEveryJointMovesByUnitQuaternions) {
  const Glb glb = parsed(file_of("figure", 15'000));
  const size_t joints = glb.json["skins"][0]["joints"].size();
  EXPECT_EQ(glb.count(glb.json["skins"][0]["inverseBindMatrices"]), joints);
  std::set<int> used;
  for (const Json& object : glb.json["meshes"]) {
    for (const Json& primitive : object["primitives"]) {
      const Json& attributes = primitive["attributes"];
      for (uint64_t i = 0; i < glb.count(attributes["POSITION"]); ++i) {
        int sum = 0;
        for (size_t k = 0; k < 4; ++k) {
          const int weight = glb.at<uint8_t>(attributes["WEIGHTS_0"], i, k);
          if (weight > 0) used.insert(glb.at<uint8_t>(attributes["JOINTS_0"], i, k));
          sum += weight;
        }
        ASSERT_EQ(sum, 255);
      }
    }
  }
  EXPECT_EQ(used.size(), joints);
  const Json& animation = glb.json["animations"][0];
  EXPECT_EQ(animation["channels"].size(), joints - 1);  // the head is held
  for (const Json& sampler : animation["samplers"]) {
    const uint64_t keys = glb.count(sampler["input"]);
    ASSERT_EQ(glb.count(sampler["output"]), keys);
    for (uint64_t i = 0; i < keys; ++i) {
      double norm = 0;
      for (size_t k = 0; k < 4; ++k) {
        const float value = glb.at<float>(sampler["output"], i, k);
        norm += double(value) * value;
        // The walk repeats.
        EXPECT_NEAR(glb.at<float>(sampler["output"], i == 0 ? keys - 1 : i, k), value, 1e-6);
      }
      EXPECT_NEAR(norm, 1, 1e-6);
    }
  }
}

TEST(Glb, OfASceneWithoutMaterialsIsAUsageError) {
  const TempFolder folder;
  EXPECT_SVDAG_ERROR(write_glb(*make_scene("city", 120, 1), {}, folder.file("a.glb")),
                     ExitCode::kUsage, "has no textures");
  EXPECT_SVDAG_ERROR(write_glb(*make_scene("atrium", 90'000, 1), {.shuffle = true}, "a.glb"),
                     ExitCode::kUsage, "--shuffle: a .glb");
}

}  // namespace
}  // namespace svdag::scenes
