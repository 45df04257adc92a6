// Draco meshes: bare files, glTF primitives, hostile data. Files are made by Draco's own encoder.
#ifdef SVDAG_HAS_DRACO
#include "io/scene/decoders/draco.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <draco/point_cloud/point_cloud_builder.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "io/scene/colours/linear_images.h"
#include "io/scene/cutouts/alpha_images.h"
#include "io/scene/decoders/image.h"
#include "tests/expect_error.h"
#include "tests/io/scene/gltf/gltf_builder.h"
#include "tests/io/scene/png_file.h"
#include "tests/sanitized.h"

namespace svdag {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int kUnquantized = 0;

// A height field of n x n quads with heights in 0 .. 1.
std::vector<std::array<std::array<float, 3>, 3>> field(int n) {
  std::mt19937 random(1);
  std::vector<float> height(size_t((n + 1) * (n + 1)));
  for (float& h : height) h = float(random() % 1000) / 1000.0f;
  const auto at = [&](int x, int y) {
    return std::array<float, 3>{float(x), float(y), height[size_t(y * (n + 1) + x)]};
  };
  std::vector<std::array<std::array<float, 3>, 3>> faces;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      faces.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
      faces.push_back({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return faces;
}

std::string encode(int n, int bits, draco::MeshEncoderMethod method) {
  const auto faces = field(n);
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(int(faces.size()));
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (size_t f = 0; f < faces.size(); ++f) {
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(uint32_t(f)), faces[f][0].data(),
                                      faces[f][1].data(), faces[f][2].data());
  }
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  if (bits != kUnquantized) {
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  }
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

struct DracoMesh {
  std::vector<Point> positions;
  std::vector<uint32_t> indices;
  double step = 0;
};

DracoMesh decode(const std::string& bytes, uint64_t limit = MemoryBudget::kUnlimited,
                 bool sandbox = false) {
  const MemoryBudget budget(limit);
  const DracoSource source{std::as_bytes(std::span(bytes))};
  DracoMesh mesh;
  const DracoReceiver receiver = {
      [&](size_t, double step) { mesh.step = step; },
      [&](auto some) { mesh.positions.insert(mesh.positions.end(), some.begin(), some.end()); },
      [&](auto some) { mesh.indices.insert(mesh.indices.end(), some.begin(), some.end()); }};
  EXPECT_EQ(decode_draco({&source, 1}, "test.drc", budget, sandbox, receiver), 1U);
  return mesh;
}

using Corner = std::array<double, 3>;

// Triangles in a canonical order: Draco keeps neither their order nor their first corner.
std::vector<std::array<Corner, 3>> canonical(std::vector<std::array<Corner, 3>> faces) {
  for (auto& f : faces) std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

std::vector<std::array<Corner, 3>> faces_of(const DracoMesh& mesh) {
  std::vector<std::array<Corner, 3>> faces(mesh.indices.size() / 3);
  for (size_t i = 0; i < 3 * faces.size(); ++i) {
    const Point& p = mesh.positions[mesh.indices[i]];
    faces[i / 3][i % 3] = {p.x, p.y, p.z};
  }
  return faces;
}

// `step` 0: the field itself; else its corners quantised from the minimum (0, 0, low).
std::vector<std::array<Corner, 3>> expected_faces(int n, double step) {
  float low = 1;
  for (const auto& f : field(n)) {
    for (const auto& p : f) low = std::min(low, p[2]);
  }
  const std::array<double, 3> minimum = {0, 0, double(low)};
  std::vector<std::array<Corner, 3>> faces;
  for (const auto& f : field(n)) {
    auto& face = faces.emplace_back();
    for (size_t i = 0; i < 3; ++i) {
      for (size_t c = 0; c < 3; ++c) {
        const double m = minimum[c];
        face[i][c] = step == 0 ? f[i][c] : m + std::floor((f[i][c] - m) / step + 0.5) * step;
      }
    }
  }
  return faces;
}

class DracoMethods : public testing::TestWithParam<draco::MeshEncoderMethod> {};

TEST_P(DracoMethods, UnquantizedTrianglesComeAsTheyAre) {
  EXPECT_EQ(canonical(faces_of(decode(encode(9, kUnquantized, GetParam())))),
            canonical(expected_faces(9, 0)));
}

TEST_P(DracoMethods, QuantizedPositionsStandOnTheirLatticeInDouble) {
  const DracoMesh mesh = decode(encode(9, 12, GetParam()));
  EXPECT_EQ(mesh.step, 9.0 / 4095);  // the extent of the field over 2^12 - 1
  EXPECT_EQ(canonical(faces_of(mesh)), canonical(expected_faces(9, 9.0 / 4095)));
}

// Corners of a mesh with a seam: the two triangles of a quad have coordinates and colours of their
// own.
std::array<float, 2> texture_at(const std::array<float, 3>& p, size_t face) {
  return {p[0] / 8 + (face % 2 == 0 ? 0.0f : 0.5f), p[1] / 4};
}
std::array<uint8_t, 4> colour_at(const std::array<float, 3>& p, size_t face) {
  return {uint8_t(10 * p[0]), uint8_t(10 * p[1]), uint8_t(face % 2 == 0 ? 51 : 204), 200};
}

std::string encode_painted(int n, draco::MeshEncoderMethod method) {
  const auto faces = field(n);
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(int(faces.size()));
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int texture =
      builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const int colour = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
  for (size_t f = 0; f < faces.size(); ++f) {
    const draco::FaceIndex face{uint32_t(f)};
    const auto set = [&](int id, const auto& value) {
      const auto a = value(faces[f][0], f), b = value(faces[f][1], f), c = value(faces[f][2], f);
      builder.SetAttributeValuesForFace(id, face, a.data(), b.data(), c.data());
    };
    set(position, [](const std::array<float, 3>& p, size_t) { return p; });
    set(texture, texture_at);
    set(colour, colour_at);
  }
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

TEST_P(DracoMethods, TextureCoordinatesAndColoursOfVerticesAreDecodedIfTheyAreWanted) {
  const int n = 4;
  const std::string drc = encode_painted(n, GetParam()), image = one_texel(9, 9, 9);
  GltfBuilder gltf;
  gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const int view = gltf.view(std::vector<char>(drc.begin(), drc.end()));
  gltf.append("images", {{"bufferView", gltf.view(std::vector<char>(image.begin(), image.end()))}});
  gltf.append("textures", {{"source", 0}});
  gltf.append("materials",
              {{"pbrMetallicRoughness",
                {{"baseColorTexture", {{"index", 0}}}, {"baseColorFactor", {0.5, 1, 1, 1}}}}});
  const auto accessor = [&](int component, const char* type) {
    return gltf.append("accessors", {{"componentType", component}, {"count", 25}, {"type", type}});
  };
  const int mesh = gltf.mesh(accessor(5126, "VEC3"));
  json& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  primitive["attributes"]["TEXCOORD_0"] = accessor(5126, "VEC2");
  primitive["attributes"]["COLOR_0"] = accessor(5121, "VEC4");
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}, {"COLOR_0", 2}}}};
  gltf.show(mesh);
  const TempFolder folder;
  const auto read = [&](bool coloured, const TriangleSink& sink) {
    MemoryBudget budget;
    LinearImages images(&budget, false, LinearImages::Detail::kWhole);
    AlphaImages alpha(&budget, false);
    const NameFilter names;
    ReadOptions options{&names, false, &budget};
    options.alpha = &alpha;
    if (coloured) options.images = &images;
    if (coloured) options.paints = &images;
    const File file = File::open_read(folder.write("a.glb", gltf.glb()));
    return read_meshes(read_gltf, file, options, sink);
  };
  CornerList plain, painted;
  read(false, [&](const TriangleBatch& batch) {
    for (const Triangle& t : batch.triangles) {
      for (const Point& p : t.v) plain.push_back({p.x, p.y, p.z});
    }
  });
  read(true, [&](const TriangleBatch& batch) {
    ASSERT_NE(batch.paint, nullptr);
    ASSERT_NE(batch.paint->image, nullptr);
    EXPECT_NEAR(batch.paint->factor[0], 0.5, 1e-4);
    EXPECT_GT(batch.quantisation, 0);
    for (size_t k = 0; k < batch.triangles.size(); ++k) {
      const auto& v = batch.triangles[k].v;
      const bool odd = batch.corner_colours[k][0][2] == light16(204 / 255.0);
      for (size_t i = 0; i < 3; ++i) {
        painted.push_back({v[i].x, v[i].y, v[i].z});
        const std::array<float, 3> p = {float(std::round(v[i].x)), float(std::round(v[i].y)), 0};
        const auto uv = texture_at(p, odd ? 1 : 0);
        EXPECT_NEAR(batch.texture[k][i].u, uv[0], 1e-3);
        EXPECT_NEAR(batch.texture[k][i].v, uv[1], 1e-3);
        const auto c = colour_at(p, odd ? 1 : 0);
        for (size_t channel = 0; channel < 3; ++channel)
          EXPECT_EQ(batch.corner_colours[k][i][channel], light16(c[channel] / 255.0));
      }
    }
  });
  EXPECT_EQ(painted, plain);
  EXPECT_EQ(plain.size(), size_t(6 * n * n));
  gltf.json["materials"][0]["alphaMode"] = "MASK";
  gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.25;
  for (const bool coloured : {false, true}) {
    size_t cut = 0;
    const LeftOut left_out = read(coloured, [&](const TriangleBatch& batch) {
      ASSERT_NE(batch.cut, nullptr);
      EXPECT_TRUE(batch.cut->is_transparent());
      EXPECT_EQ(batch.texture.size(), batch.triangles.size());
      cut += batch.triangles.size();
    });
    EXPECT_EQ(cut, size_t(2 * n * n));
    EXPECT_EQ(left_out[size_t(Omission::kVertexAlpha)], 1u);
  }
  json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  attributes.erase("TEXCOORD_0");  // the compressed ones count
  read(true, [](const TriangleBatch& batch) { EXPECT_FALSE(batch.texture.empty()); });
  attributes.erase("COLOR_0");
  EXPECT_SVDAG_ERROR(read(true, [](const TriangleBatch&) {}), ExitCode::kBadInput, "COLOR_0");
  attributes["COLOR_0"] = 2;
  gltf.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
           ["TEXCOORD_0"] = 7;
  EXPECT_SVDAG_ERROR(read(true, [](const TriangleBatch&) {}), ExitCode::kBadInput,
                     "no attribute 7 of 2 components");
}

TEST_P(DracoMethods, NoDamagedByteCrashes) {
  const std::string whole = encode(4, 11, GetParam());
  size_t errors = 0;
  const auto attempt = [&](const std::string& bytes) {
    try {
      decode(bytes, uint64_t(1) << 30);
    } catch (const Error& error) {
      ++errors;
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
    }
  };
  for (size_t size = 0; size < whole.size(); ++size) attempt(whole.substr(0, size));
  EXPECT_EQ(errors, whole.size());
  for (size_t i = 0; i < whole.size(); ++i) {
    for (const int flip : {1, 16, 128, 255}) {
      std::string bytes = whole;
      bytes[i] = char(bytes[i] ^ flip);
      attempt(bytes);
    }
  }
}

TEST_P(DracoMethods, ALimitedChildDecodesTheSame) {
  for (const int bits : {kUnquantized, 12}) {
    const std::string bytes = encode(100, bits, GetParam());
    const DracoMesh mesh = decode(bytes), limited = decode(bytes, uint64_t(1) << 28, true);
    EXPECT_EQ(limited.positions, mesh.positions);
    EXPECT_EQ(limited.indices, mesh.indices);
    EXPECT_EQ(limited.step, mesh.step);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, DracoMethods,
                         testing::Values(draco::MESH_SEQUENTIAL_ENCODING,
                                         draco::MESH_EDGEBREAKER_ENCODING));

// Header, method, then counts as variable-length integers (bitstream 2.2).
std::string claim(char method, std::initializer_list<uint32_t> counts) {
  std::string bytes = std::string("DRACO\x02\x02\x01", 8) + method + std::string(2, '\0');
  if (method == draco::MESH_EDGEBREAKER_ENCODING) bytes += '\0';  // standard traversal
  for (uint32_t v : counts) {
    for (; v >= 128; v >>= 7) bytes += char(v | 128);
    bytes += char(v);
  }
  return bytes + std::string(40, '\0');
}

TEST(DracoHostile, ClaimsBeyondTheBytesAreRefusedWhateverTheBudget) {
  for (const uint32_t count : {uint32_t(1) << 24, uint32_t(1) << 30, UINT32_MAX}) {
    for (const std::string& bytes : {claim(draco::MESH_SEQUENTIAL_ENCODING, {count, 3}),
                                     claim(draco::MESH_SEQUENTIAL_ENCODING, {1, count}),
                                     claim(draco::MESH_EDGEBREAKER_ENCODING, {3, count}),
                                     claim(draco::MESH_EDGEBREAKER_ENCODING, {count, 1})}) {
      EXPECT_SVDAG_ERROR(decode(bytes), ExitCode::kBadInput, "test.drc");
    }
  }
}

TEST(DracoHostile, ClaimsInsideTheBoundAreAMatterOfTheBudget) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer needs address space";
  const std::string bytes =
      claim(draco::MESH_EDGEBREAKER_ENCODING, {20'000'000, 40'000'000, 0, 40'000'000}) +
      std::string(20'000, '\0');
  for (const bool sandbox : {false, true})
    EXPECT_SVDAG_ERROR(decode(bytes, uint64_t(1) << 20, sandbox), ExitCode::kMemory,
                       "raise --memory");
}

TEST(DracoHostile, ALimitedChildSaysTheSameOfIt) {
  for (const std::string& bytes : {claim(draco::MESH_SEQUENTIAL_ENCODING, {UINT32_MAX, 3}),
                                   claim(draco::MESH_EDGEBREAKER_ENCODING, {3, 100'000}),
                                   std::string("DRACO"), std::string()}) {
    const auto sentence = [&](bool sandbox) {
      try {
        decode(bytes, uint64_t(1) << 28, sandbox);
      } catch (const Error& error) {
        return std::to_string(int(error.code())) + error.what();
      }
      return std::string("nothing");
    };
    EXPECT_EQ(sentence(true), sentence(false));
    EXPECT_THAT(sentence(true), HasSubstr("test.drc"));
  }
}

TEST(DracoHostile, APointCloudIsNamedAsSuch) {
  draco::PointCloudBuilder builder;
  builder.Start(1);
  const std::array<float, 3> point = {1, 2, 3};
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  builder.SetAttributeValueForPoint(id, draco::PointIndex(0), point.data());
  draco::EncoderBuffer buffer;
  ASSERT_TRUE(draco::Encoder().EncodePointCloudToBuffer(*builder.Finalize(false), &buffer).ok());
  try {
    decode({buffer.data(), buffer.size()});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("point cloud"));
  }
}

TEST(DracoGltf, ACompressedPrimitiveIsDecodedAndPlaced) {
  const std::string drc = encode(9, 12, draco::MESH_EDGEBREAKER_ENCODING);
  GltfBuilder gltf;
  gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const int view = gltf.view(std::vector<char>(drc.begin(), drc.end()));
  const int mesh = gltf.mesh(
      gltf.append("accessors", {{"componentType", 5126}, {"count", 100}, {"type", "VEC3"}}));
  gltf.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", 0}}}};
  gltf.scene({gltf.append("nodes", {{"mesh", mesh}, {"translation", {0, 0, 32}}})});
  const DracoMesh bare = decode(drc);
  CornerList expected;
  for (const uint32_t i : bare.indices) {
    const Point& p = bare.positions[i];
    expected.push_back({p.x, p.y, p.z + 32});
  }
  EXPECT_EQ(read_corners(gltf), expected);
  gltf.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
           ["POSITION"] = 5;
  EXPECT_THAT(failure(gltf), HasSubstr("positions"));
}

// A mesh of `n` x `n` quads in `view`, under a node at height z.
int compressed_node(GltfBuilder* gltf, int view, int z) {
  const int mesh = gltf->mesh(
      gltf->append("accessors", {{"componentType", 5126}, {"count", 9}, {"type", "VEC3"}}));
  gltf->json["meshes"][size_t(mesh)]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] =
      {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}};
  return gltf->append("nodes", {{"mesh", mesh}, {"translation", {0, 0, z}}});
}

// One child decodes several primitives; those that no node draws may be broken.
TEST(DracoGltf, ABrokenPrimitiveMattersOnlyIfItIsDrawn) {
  const std::string drc = encode(2, kUnquantized, draco::MESH_EDGEBREAKER_ENCODING);
  GltfBuilder gltf;
  gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const int whole = gltf.view(std::vector<char>(drc.begin(), drc.end()));
  const int broken = gltf.view(std::vector<char>(drc.begin(), drc.end() - 5));
  std::vector<int> nodes;
  for (const int view : {whole, whole, broken, whole, 999, whole})
    nodes.push_back(compressed_node(&gltf, view, 10 * int(nodes.size())));
  const int again = gltf.append("nodes", {{"mesh", 1}, {"translation", {0, 0, 60}}});
  gltf.scene({nodes[0], nodes[1], nodes[3], nodes[5], again});
  const DracoMesh bare = decode(drc);
  CornerList expected;
  for (const int z : {0, 10, 30, 50, 60}) {
    for (const uint32_t i : bare.indices)
      expected.push_back({bare.positions[i].x, bare.positions[i].y, bare.positions[i].z + z});
  }
  EXPECT_EQ(read_corners(gltf), expected);
  gltf.json["scenes"][0]["nodes"].push_back(nodes[2]);
  EXPECT_THAT(failure(gltf), HasSubstr("broken Draco data"));
}

// The indices may be compressed although the positions are not: these are not zeros.
TEST(DracoGltf, IndicesWithoutPlainDataAreNotTakenForZeros) {
  GltfBuilder gltf;
  gltf.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  const int positions = gltf.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  gltf.show(gltf.mesh(positions));
  nlohmann::json& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["indices"] =
      gltf.append("accessors", {{"componentType", 5125}, {"count", 3}, {"type", "SCALAR"}});
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                           {"attributes", {{"NORMAL", 0}}}};
  EXPECT_NE(failure(gltf), "");
}

TEST(DracoGltf, PlainDataIsPreferredToCompressed) {
  GltfBuilder gltf;
  gltf.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  const int mesh = gltf.mesh(gltf.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3"));
  gltf.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 99}, {"attributes", {{"POSITION", 0}}}};
  gltf.show(mesh);
  EXPECT_EQ(read_corners(gltf), (CornerList{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

}  // namespace
}  // namespace svdag
#endif
