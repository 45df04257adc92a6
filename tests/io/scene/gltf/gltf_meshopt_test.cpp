// EXT_meshopt_compression: compressed views give the corners of the plain file.
#ifdef SVDAG_HAS_MESHOPT

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

#include "io/scene/decoders/meshopt.h"
#include "tests/io/scene/gltf/gltf_builder.h"

namespace svdag {
namespace {

using nlohmann::json;

// A wavy sheet of n x n vertices.
struct Sheet {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
};

Sheet sheet(int n) {
  Sheet s;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const float height = std::floor(8 * std::sin(0.3F * float(x) + 0.1F * float(y)));
      s.positions.insert(s.positions.end(), {float(x), height, float(y)});
      if (x == 0 || y == 0) continue;
      const uint32_t at = uint32_t(y * n + x), up = at - uint32_t(n);
      s.indices.insert(s.indices.end(), {at, up, up - 1, at, up - 1, at - 1});
    }
  }
  return s;
}

std::string encoded_vertices(const void* data, size_t count, size_t stride) {
  std::string bytes(meshopt_encodeVertexBufferBound(count, stride), '\0');
  bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                          bytes.size(), data, count, stride));
  return bytes;
}

// The codec may turn a triangle's corners, so each begins with its smallest.
CornerList turned(CornerList corners) {
  for (size_t i = 0; i < corners.size(); i += 3) {
    const auto first = corners.begin() + ptrdiff_t(i);
    std::rotate(first, std::min_element(first, first + 3), first + 3);
  }
  return corners;
}

class Meshopt : public testing::Test {
 protected:
  // Replaces the data of buffer view `view` by `bytes` and the extension.
  void compress(int view, const std::string& bytes, const json& extension) {
    while (gltf_.bytes.size() % 4 != 0) gltf_.bytes += '\0';
    json packed = {{"buffer", 0}, {"byteOffset", gltf_.bytes.size()}, {"byteLength", bytes.size()}};
    packed.update(extension);
    gltf_.bytes += bytes;
    json& object = gltf_.json["bufferViews"][size_t(view)];
    object["buffer"] = 1;  // without data
    object["extensions"]["EXT_meshopt_compression"] = packed;
    gltf_.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  }
  json& packed(int view) {
    return gltf_.json["bufferViews"][size_t(view)]["extensions"]["EXT_meshopt_compression"];
  }
  GltfBuilder gltf_;
};

TEST_F(Meshopt, TrianglesAndPositionsAreThoseOfThePlainFile) {
  const Sheet s = sheet(60);
  const int positions = gltf_.accessor(s.positions, "VEC3");
  const int indices = gltf_.accessor(s.indices, "SCALAR");
  gltf_.show(gltf_.mesh(positions, indices));
  const CornerList plain = read_corners(gltf_);
  const size_t vertices = s.positions.size() / 3;
  compress(0, encoded_vertices(s.positions.data(), vertices, 12),
           {{"byteStride", 12}, {"count", vertices}, {"mode", "ATTRIBUTES"}});
  std::string bytes(meshopt_encodeIndexBufferBound(s.indices.size(), vertices), '\0');
  bytes.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                         bytes.size(), s.indices.data(), s.indices.size()));
  EXPECT_LT(bytes.size(), s.indices.size());  // a fourth
  compress(1, bytes, {{"byteStride", 4}, {"count", s.indices.size()}, {"mode", "TRIANGLES"}});
  EXPECT_EQ(turned(read_corners(gltf_)), turned(plain));
}

TEST_F(Meshopt, IndexSequencesKeepTheirOrder) {
  const Sheet s = sheet(20);
  const int positions = gltf_.accessor(s.positions, "VEC3");
  gltf_.show(gltf_.mesh(positions, gltf_.accessor(s.indices, "SCALAR"), 5));  // a strip
  const CornerList plain = read_corners(gltf_);
  std::string bytes(meshopt_encodeIndexSequenceBound(s.indices.size(), 400), '\0');
  bytes.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(bytes.data()),
                                           bytes.size(), s.indices.data(), s.indices.size()));
  compress(1, bytes, {{"byteStride", 4}, {"count", s.indices.size()}, {"mode", "INDICES"}});
  EXPECT_EQ(read_corners(gltf_), plain);
}

TEST_F(Meshopt, ExponentialPositionsAreMantissaTimesPowerOfTwo) {
  const Sheet s = sheet(20);
  const int positions = gltf_.accessor(s.positions, "VEC3");
  gltf_.show(gltf_.mesh(positions));
  gltf_.json["accessors"][0]["count"] = 399;  // whole triangles
  const CornerList plain = read_corners(gltf_);
  std::vector<uint32_t> words;  // exponent 2^-1, mantissa 2 * value
  for (const float value : s.positions)
    words.push_back(0xff000000U | (uint32_t(int32_t(2 * value)) & 0xffffffU));
  compress(0, encoded_vertices(words.data(), 400, 12),
           {{"byteStride", 12}, {"count", 400}, {"mode", "ATTRIBUTES"}, {"filter", "EXPONENTIAL"}});
  EXPECT_EQ(read_corners(gltf_), plain);
}

TEST_F(Meshopt, TheDecoderNeedsNoSystemCallThatTheSandboxForbids) {
  const Sheet s = sheet(60);
  const size_t vertices = s.positions.size() / 3;
  const std::string bytes = encoded_vertices(s.positions.data(), vertices, 12);
  std::string decoded;
  decode_meshopt({std::as_bytes(std::span(bytes)), "a.glb", true}, {"ATTRIBUTES", "", vertices, 12},
                 MemoryBudget(), [&](std::span<const std::byte> block) {
                   decoded.append(reinterpret_cast<const char*>(block.data()), block.size());
                 });
  EXPECT_EQ(decoded, std::string(reinterpret_cast<const char*>(s.positions.data()),
                                 s.positions.size() * sizeof(float)));
}

TEST_F(Meshopt, WhatIsBrokenOrNotAllowedIsAnError) {
  const Sheet s = sheet(20);
  gltf_.show(gltf_.mesh(gltf_.accessor(s.positions, "VEC3")));
  gltf_.json["accessors"][0]["count"] = 399;
  const std::string bytes = encoded_vertices(s.positions.data(), 400, 12);
  const json good = {{"byteStride", 12}, {"count", 400}, {"mode", "ATTRIBUTES"}};
  compress(0, bytes, good);
  const GltfBuilder whole = gltf_;
  EXPECT_EQ(read_corners(whole).size(), 399U);
  const auto fails_with = [&](const char* key, const json& value, const char* expected) {
    gltf_ = whole;
    packed(0)[key] = value;
    EXPECT_NE(failure(gltf_).find(expected), std::string::npos) << key << " " << value;
  };
  fails_with("mode", "TRIANGLES", "not allowed");
  fails_with("mode", "VERTICES", "not allowed");
  fails_with("filter", "QUATERNION", "not allowed");
  fails_with("byteStride", 10, "not allowed");
  fails_with("byteStride", 0, "not allowed");
  fails_with("count", 1'000'000'000'000, "more than its data can hold");
  fails_with("count", 800, "broken EXT_meshopt_compression data");
  fails_with("byteLength", bytes.size() - 1, "broken EXT_meshopt_compression data");
  fails_with("byteLength", 0, "broken EXT_meshopt_compression data");
  fails_with("buffer", 7, "buffers[7]");
  fails_with("byteOffset", 100'000'000, "outside its buffer");
  fails_with("count", 300, "broken EXT_meshopt_compression data");
  gltf_ = whole;
  gltf_.json["accessors"][0]["count"] = 402;
  EXPECT_NE(failure(gltf_).find("does not fit bufferViews[0]"), std::string::npos);
}

}  // namespace
}  // namespace svdag

#endif
