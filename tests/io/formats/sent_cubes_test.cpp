// What a child sends is a grid of cubes or an Error, whatever it sends.
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
constexpr uint64_t kMuch = uint64_t(1) << 30;

CubeHead head(uint32_t name_bytes = 4) {
  CubeHead head{};
  head.type = CubeType::kBool;
  head.name_bytes = name_bytes;
  head.origin = {1, 2, 3};
  for (size_t a = 0; a < 3; ++a) head.axes[a][a] = 0.5;
  return head;
}

Bytes head_block(const CubeHead& head, const std::string& name) {
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

SentCubes received(const std::vector<CubeRecord>& records, uint64_t most = kMuch) {
  SentCubes cubes("x.vdb", most);
  cubes.take(head_block(head(), "name"));
  cubes.take(std::as_bytes(std::span(records)));
  cubes.finish();
  return cubes;
}

TEST(SentCubes, AHeadNamesTheGridAndItsPlace) {
  const SentCubes cubes = received({});
  EXPECT_EQ(cubes.name(), "name");
  EXPECT_EQ(cubes.type(), "bool");
  EXPECT_EQ(cubes.centres()({2, 0, 4}), Point(2, 2, 5));
  EXPECT_TRUE(cubes.bounds().empty());
  EXPECT_FALSE(cubes.get({0, 0, 0}));
}

TEST(SentCubes, EveryVoxelIsFoundInWhateverOrderItsCubeCame) {
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
    const SentCubes cubes = received(records);
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

TEST(SentCubes, ACubeOfTheLargestSideIsNotExpanded) {
  const int32_t last = std::numeric_limits<int32_t>::max() - 4095;
  const SentCubes cubes = received({tile({0, 0, 0}, 4096), tile({last, 0, 0}, 4096)});
  EXPECT_TRUE(cubes.get({4095, 4095, 4095}));
  EXPECT_TRUE(cubes.get(LatticePoint((int64_t(1) << 31) - 1, 0, 0)));
  EXPECT_FALSE(cubes.get({4096, 0, 0}));
  EXPECT_EQ(cubes.bounds().max.x, int64_t(1) << 31);
}

TEST(SentCubes, HeadsOfNoGridAreRefused) {
  const auto refused = [](const Bytes& block, const char* part) {
    SentCubes cubes("x.vdb", kMuch);
    EXPECT_SVDAG_ERROR(cubes.take(block), ExitCode::kBadInput, part);
  };
  const char* no_grid = "sent an invalid grid";
  refused({}, no_grid);
  refused(Bytes(sizeof(CubeHead) - 1), no_grid);
  refused(head_block(head(3), "name"), no_grid);
  refused(head_block(head(5), "name"), no_grid);
  refused(head_block(head(256), std::string(256, 'a')), no_grid);
  refused(head_block(head(0xffffffff), "name"), no_grid);
  refused(head_block(head(4), "na\x1b["), no_grid);
  CubeHead wrong = head();
  wrong.type = CubeType(3);
  refused(head_block(wrong, "name"), no_grid);
  wrong = head();
  wrong.axes[2][1] = std::numeric_limits<double>::infinity();
  refused(head_block(wrong, "name"), "not finite");
  wrong = head();
  wrong.origin[0] = std::nan("");
  refused(head_block(wrong, "name"), "not finite");
  SentCubes none("x.vdb", kMuch);
  EXPECT_SVDAG_ERROR(none.finish(), ExitCode::kBadInput, no_grid);
}

TEST(SentCubes, PlacesWhereNoCubeCanBeAreRefused) {
  const int32_t last = std::numeric_limits<int32_t>::max();
  for (const CubeRecord& wrong :
       {leaf({4, 0, 0}), leaf({0, 0, -7}), leaf({last, 0, 0}), leaf({0, 0, 0}, 0),
        tile({64, 0, 0}, 128), tile({128, 0, 0}, 4096), tile({0, 0, 0}, 0), tile({0, 0, 0}, 1),
        tile({0, 0, 0}, 16), tile({0, 0, 0}, 1U << 31)}) {
    EXPECT_SVDAG_ERROR(received({wrong}), ExitCode::kBadInput, "impossible position");
  }
  SentCubes cut("x.vdb", kMuch);
  cut.take(head_block(head(), "name"));
  EXPECT_SVDAG_ERROR(cut.take(Bytes(sizeof(CubeRecord) + 1)), ExitCode::kBadInput, "invalid grid");
}

TEST(SentCubes, VoxelsThatComeTwiceAreRefused) {
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

TEST(SentCubes, AFloodEnds) {
  SentCubes cubes("x.vdb", 1000);
  cubes.take(head_block(head(), "name"));
  const auto flood = [&](uint32_t side) {
    for (int32_t i = 0; i < 1000; ++i) {
      const CubeRecord record = side == 0 ? leaf({8 * i, 0, 0}) : tile({128 * i, 0, 0}, side);
      cubes.take(std::as_bytes(std::span(&record, 1)));
    }
  };
  EXPECT_SVDAG_ERROR(flood(0), ExitCode::kBadInput, "more blocks than a file of its size");
  EXPECT_SVDAG_ERROR(flood(128), ExitCode::kBadInput, "more blocks than a file of its size");
}

}  // namespace
}  // namespace svdag
