// Any bytes that a decoder sends give a valid grid of cubes or an Error.
#include "io/formats/sent_cubes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "tests/expect_error.h"

namespace svdag {
namespace {

using Bytes = std::vector<std::byte>;
constexpr uint64_t kNoLimit = uint64_t(1) << 30;

CubeHeader head(uint32_t name_bytes = 4) {
  CubeHeader head{};
  head.type = CubeValueType::kBool;
  head.name_bytes = name_bytes;
  head.origin = {1, 2, 3};
  for (size_t a = 0; a < 3; ++a) head.axes[a][a] = 0.5;
  return head;
}

Bytes head_block(const CubeHeader& head, const std::string& name) {
  Bytes block(sizeof head + name.size());
  std::memcpy(block.data(), &head, sizeof head);
  std::memcpy(block.data() + sizeof head, name.data(), name.size());
  return block;
}

CubeRecord leaf(const std::array<int32_t, 3>& origin, uint64_t word = 5) {
  return {origin, 8, {word}};
}
CubeRecord tile(const std::array<int32_t, 3>& origin, uint32_t side) {
  CubeRecord record{origin, side, {}};
  record.words.fill(~uint64_t(0));
  return record;
}

DecodedGrid received(const std::vector<CubeRecord>& records, uint64_t max_bytes = kNoLimit) {
  DecodedGrid cubes("x.vdb", max_bytes);
  cubes.receive(head_block(head(), "name"));
  cubes.receive(std::as_bytes(std::span(records)));
  cubes.finish();
  return cubes;
}

TEST(DecodedGrid, AHeaderNamesTheGridAndItsTransform) {
  const DecodedGrid cubes = received({});
  EXPECT_EQ(cubes.name(), "name");
  EXPECT_EQ(cubes.type(), "bool");
  EXPECT_EQ(cubes.centres()({2, 0, 4}), Point(2, 2, 5));
  EXPECT_TRUE(cubes.bounds().empty());
  EXPECT_FALSE(cubes.get({0, 0, 0}));
}

TEST(DecodedGrid, EveryVoxelIsFoundInAnyOrderOfCubes) {
  // One of each size, on both sides of zero and of the borders of larger nodes.
  std::vector<CubeRecord> records;
  for (const int32_t x : {-4096, -136, -8, 0, 120, 4096})
    for (const int32_t z : {-8, 0, 8, 128}) records.push_back(leaf({x, 16, z}));
  records.push_back(tile({128, 0, 0}, 8));
  records.push_back(tile({256, 128, 0}, 128));
  const auto is_set = [&](const LatticePoint& at) {
    return std::any_of(records.begin(), records.end(), [&](const CubeRecord& record) {
      const LatticePoint in =
          at - LatticePoint(record.origin[0], record.origin[1], record.origin[2]);
      for (int a = 0; a < 3; ++a)
        if (in[a] < 0 || in[a] >= int64_t(record.side)) return false;
      return record.side > 8 || (record.words[size_t(in.x)] >> (8 * in.y + in.z) & 1) != 0;
    });
  };
  std::mt19937 random(3);
  for (int run = 0; run < 5; ++run) {
    const DecodedGrid cubes = received(records);
    uint64_t count = 0;
    cubes.visit([&](const VoxelCube& cube) { return count += cube.count(); });
    EXPECT_EQ(count, (1U << 21) + 512 + 6 * 4 * 2);
    EXPECT_EQ(cubes.bounds().min, LatticePoint(-4096, 0, -8));
    EXPECT_EQ(cubes.bounds().max, LatticePoint(4104, 256, 136));
    for (int i = 0; i < 3000; ++i) {
      const CubeRecord& near = records[random() % records.size()];
      LatticePoint at;
      for (int a = 0; a < 3; ++a)
        at[a] = near.origin[size_t(a)] - 2 + int64_t(random() % (near.side + 4));
      EXPECT_EQ(cubes.get(at), is_set(at));
    }
    std::shuffle(records.begin(), records.end(), random);
  }
}

TEST(DecodedGrid, ACubeOfTheLargestSideIsNotExpanded) {
  const int32_t last = std::numeric_limits<int32_t>::max() - 4095;
  const DecodedGrid cubes = received({tile({0, 0, 0}, 4096), tile({last, 0, 0}, 4096)});
  EXPECT_TRUE(cubes.get({4095, 4095, 4095}));
  EXPECT_TRUE(cubes.get(LatticePoint((int64_t(1) << 31) - 1, 0, 0)));
  EXPECT_FALSE(cubes.get({4096, 0, 0}));
  EXPECT_EQ(cubes.bounds().max.x, int64_t(1) << 31);
}

TEST(DecodedGrid, InvalidHeadersAreRejected) {
  const auto expect_rejected = [](const Bytes& block, const char* part) {
    DecodedGrid cubes("x.vdb", kNoLimit);
    EXPECT_SVDAG_ERROR(cubes.receive(block), ExitCode::kBadInput, part);
  };
  const char* invalid = "sent an invalid grid";
  expect_rejected({}, invalid);
  expect_rejected(Bytes(sizeof(CubeHeader) - 1), invalid);
  expect_rejected(head_block(head(3), "name"), invalid);
  expect_rejected(head_block(head(5), "name"), invalid);
  expect_rejected(head_block(head(256), std::string(256, 'a')), invalid);
  expect_rejected(head_block(head(0xffffffff), "name"), invalid);
  expect_rejected(head_block(head(4), "na\x1b["), invalid);
  CubeHeader wrong = head();
  wrong.type = CubeValueType(3);
  expect_rejected(head_block(wrong, "name"), invalid);
  wrong = head();
  wrong.axes[2][1] = std::numeric_limits<double>::infinity();
  expect_rejected(head_block(wrong, "name"), "not finite");
  wrong = head();
  wrong.origin[0] = std::nan("");
  expect_rejected(head_block(wrong, "name"), "not finite");
  DecodedGrid none("x.vdb", kNoLimit);
  EXPECT_SVDAG_ERROR(none.finish(), ExitCode::kBadInput, invalid);
}

TEST(DecodedGrid, CubesAtImpossiblePositionsAreRejected) {
  const int32_t last = std::numeric_limits<int32_t>::max();
  for (const CubeRecord& wrong :
       {leaf({4, 0, 0}), leaf({0, 0, -7}), leaf({last, 0, 0}), leaf({0, 0, 0}, 0),
        tile({64, 0, 0}, 128), tile({128, 0, 0}, 4096), tile({0, 0, 0}, 0), tile({0, 0, 0}, 1),
        tile({0, 0, 0}, 16), tile({0, 0, 0}, 1U << 31)}) {
    EXPECT_SVDAG_ERROR(received({wrong}), ExitCode::kBadInput, "impossible position");
  }
  DecodedGrid cut("x.vdb", kNoLimit);
  cut.receive(head_block(head(), "name"));
  EXPECT_SVDAG_ERROR(cut.receive(Bytes(sizeof(CubeRecord) + 1)), ExitCode::kBadInput,
                     "invalid grid");
}

TEST(DecodedGrid, OverlappingCubesAreRejected) {
  const std::vector<std::vector<CubeRecord>> all = {
      {leaf({8, 0, 0}), leaf({16, 0, 0}), leaf({8, 0, 0})},
      {tile({8, 0, 0}, 8), leaf({8, 0, 0})},
      {tile({128, 0, 0}, 128), leaf({-8, 0, 0}), leaf({248, 8, 16})},
      {tile({-4096, 0, 0}, 4096), tile({-4096, 0, 0}, 128)},
      {tile({-4096, 0, 0}, 128), tile({-4096, 0, 0}, 4096)},
      {tile({0, 0, 0}, 4096), tile({4096, 0, 0}, 8), tile({3968, 128, 0}, 128)}};
  for (const auto& records : all)
    EXPECT_SVDAG_ERROR(received(records), ExitCode::kBadInput, "the same voxels");
}

TEST(DecodedGrid, TooManyCubesAreRejected) {
  DecodedGrid cubes("x.vdb", 1000);
  cubes.receive(head_block(head(), "name"));
  const auto send_many = [&](uint32_t side) {
    for (int32_t i = 0; i < 1000; ++i) {
      const CubeRecord record = side == 0 ? leaf({8 * i, 0, 0}) : tile({128 * i, 0, 0}, side);
      cubes.receive(std::as_bytes(std::span(&record, 1)));
    }
  };
  EXPECT_SVDAG_ERROR(send_many(0), ExitCode::kBadInput, "more blocks than a file of its size");
  EXPECT_SVDAG_ERROR(send_many(128), ExitCode::kBadInput, "more blocks than a file of its size");
}

}  // namespace
}  // namespace svdag
