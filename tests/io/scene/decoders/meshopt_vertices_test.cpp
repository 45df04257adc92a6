#include "io/scene/decoders/meshopt_vertices.h"

#include <gtest/gtest.h>

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace svdag {
namespace {

// 40 vertices, as meshoptimizer 0.23 encodes them at level 3: differences of bytes and the xor of
// rotated words.
constexpr std::string_view kEncoded =
    "a19a95ff2a051125520374610633601646106341336451027700000000152aaaaaaaaaaaaaaaaaaa0000152a"
    "aaaaaaaaaaaaaaaaaa00002a055555555555555555555555555555555555555500000000009d9d9d9d9d9d9d"
    "9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d00f2f4f4f2f4f4f2f4f4f2f4"
    "f4f2f4f4f4f2f4f4f2f4f4f2f4f4f2f4f4f4f2f4f4f2f4f4f2f4f4f2006e6e706e706e706e706e706e706e70"
    "6e706e706e6e706e706e706e706e706e706e706e706e706e00c3c3c3c3c1c3c3c3c3c1c3c3c3c1c3c3c3c3c1"
    "c3c3c3c3c1c3c3c3c1c3c3c3c3c1c3c3c3c1c3c3000000000000000000000000800000ffff00000000220000";
constexpr uint64_t kStride = 12, kCount = 40;

std::vector<std::byte> encoded() {
  std::vector<std::byte> bytes;
  for (size_t i = 0; i < kEncoded.size(); i += 2)
    bytes.push_back(std::byte(std::stoi(std::string(kEncoded.substr(i, 2)), nullptr, 16)));
  return bytes;
}

std::vector<std::byte> expected() {
  std::vector<std::byte> bytes(kStride * kCount);
  for (uint64_t i = 0; i < kCount; ++i) {
    const uint32_t flags = uint32_t((i * i * 5 + i) * 2654435761u >> 29 & 7) << 14 | 0x80000000;
    const uint16_t shorts[] = {uint16_t(i * 257), uint16_t(65535 - 3 * i)};
    const uint32_t noise = uint32_t(i * 2654435761u);
    std::memcpy(bytes.data() + i * kStride, &flags, 4);
    std::memcpy(bytes.data() + i * kStride + 4, shorts, 4);
    std::memcpy(bytes.data() + i * kStride + 8, &noise, 4);
  }
  return bytes;
}

TEST(MeshoptVertices, Version1IsDecoded) {
  const auto data = encoded();
  ASSERT_TRUE(is_meshopt_version_1(data));
  std::vector<std::byte> out(kStride * kCount);
  EXPECT_TRUE(decode_meshopt_vertices(data, kStride, out));
  EXPECT_EQ(out, expected());
}

TEST(MeshoptVertices, DamagedDataIsRefusedOrOtherVertices) {
  const auto data = encoded();
  std::vector<std::byte> out(kStride * kCount), longer(kStride * (kCount + 1));
  EXPECT_FALSE(decode_meshopt_vertices(data, kStride, longer));
  for (size_t size = 0; size < data.size(); ++size)
    EXPECT_FALSE(decode_meshopt_vertices(std::span(data).first(size), kStride, out)) << size;
  for (size_t i = 0; i < data.size(); ++i) {
    for (const int bit : {0, 1, 2, 7}) {
      auto damaged = data;
      damaged[i] ^= std::byte(1 << bit);
      (void)decode_meshopt_vertices(damaged, kStride, out);  // reads no byte outside
    }
  }
}

}  // namespace
}  // namespace svdag
