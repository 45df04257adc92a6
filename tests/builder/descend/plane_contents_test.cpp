// Contents of cubes of 8x8x8 voxels by column heights, against the definition in integers.
#include "builder/descend/plane_contents.h"

#include <gtest/gtest.h>

#include <array>
#include <bitset>
#include <cstdlib>
#include <random>

namespace svdag {
namespace {

using Voxels = std::bitset<512>;  // bit 64 x + 8 y + z

constexpr int kContentLevels = 12;
constexpr int64_t kContentVoxel = int64_t(1) << fraction_bits(kContentLevels);

struct Normal {
  int64_t n[3];
};

// Draws normals of all kinds: axis-aligned, diagonal, of small integers, rounded at 2^28.
Normal draw_normal(std::mt19937_64& random) {
  constexpr int64_t kReach[] = {1, 3, 1000, int64_t(1) << 28};
  const int64_t reach = kReach[random() % 4];
  Normal normal;
  do {
    for (int64_t& x : normal.n) x = int64_t(random() % uint64_t(2 * reach + 1)) - reach;
    if (reach > 3) normal.n[random() % 3] = random() % 2 ? reach : -reach;
  } while (normal.n[0] == 0 && normal.n[1] == 0 && normal.n[2] == 0);
  return normal;
}

// The range of offsets that set the voxel (x, y, z), see builder/descend/plane_memo.h.
OffsetRange voxel_range(const Normal& normal, Rule rule, const std::array<int64_t, 3>& voxel) {
  int64_t at = 0, negative = 0, positive = 0, dominant = 0;
  for (size_t a = 0; a < 3; ++a) {
    at += normal.n[a] * voxel[a] * kContentVoxel;
    (normal.n[a] < 0 ? negative : positive) += normal.n[a] * kContentVoxel;
    dominant = std::max(dominant, std::abs(normal.n[a]) * kContentVoxel);
  }
  if (rule == Rule::kConservative) return {at + negative, at + positive};
  const int64_t middle = at + (negative + positive) / 2;
  return {middle - dominant / 2 + 1, middle + dominant / 2};
}

Voxels voxels_at(const Normal& normal, Rule rule, int64_t offset) {
  Voxels voxels;
  for (int64_t i = 0; i < 512; ++i) {
    const OffsetRange range = voxel_range(normal, rule, {i >> 6, i >> 3 & 7, i & 7});
    voxels[size_t(i)] = range.low <= offset && offset <= range.high;
  }
  return voxels;
}

Voxels voxels_of(const NodeTable& table, int level, uint32_t node) {
  Voxels voxels;
  for (unsigned c = 0; node != 0 && c < 8; ++c) {
    const uint32_t child = table.node(level, node - 1)[c];
    for (unsigned i = 0; child != 0 && i < 64; ++i) {
      const unsigned x = 4 * (c >> 2) + (i >> 4), y = 4 * (c >> 1 & 1) + (i >> 2 & 3);
      const unsigned z = 4 * (c & 1) + (i & 3);
      const Brick brick = table.brick(child - 1);
      voxels[64 * x + 8 * y + z] = (brick >> brick_bit(i >> 4, i >> 2 & 3, i & 3) & 1) != 0;
    }
  }
  return voxels;
}

// An offset at which the plane passes close to the cube: any, or next to where a voxel changes.
int64_t draw_offset(std::mt19937_64& random, const Normal& normal, Rule rule) {
  const auto coordinate = [&] { return int64_t(random() % 10) - 1; };
  const OffsetRange range = voxel_range(normal, rule, {coordinate(), coordinate(), coordinate()});
  if (random() % 2 != 0)
    return range.low + int64_t(random() % uint64_t(range.high - range.low + 1));
  return (random() % 2 != 0 ? range.low : range.high) + int64_t(random() % 65) - 32;
}

struct ContentCase {
  Normal normal;
  OffsetRange range;
  PlaneContents::Query query;
  PlaneAnswer answer;
};

TEST(PlaneContents, AreTheVoxelsOfTheDefinitionOverTheirWholeInterval) {
  std::mt19937_64 random(1);
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    for (int round = 0; round < 20; ++round) {
      MemoryBudget budget;
      NodeTable table(kContentLevels, &budget);
      PlaneContents contents(kContentLevels, rule, &kernels(), &table);
      contents.allocate(PlaneContents::table_bytes(1 << 20));
      PlaneMemoCounts counts;
      std::vector<ContentCase> cases;
      for (int i = 0; i < 1000; ++i) {
        ContentCase c{draw_normal(random), {}, {}, {}};
        c.range.low = draw_offset(random, c.normal, rule);
        c.range.high = c.range.low + int64_t(random() % 3);
        const PlaneHeights heights = contents.heights_of(c.normal.n);
        const auto query = contents.query(heights, c.range);
        if (!query) continue;
        c.query = *query;
        c.answer = contents.find(heights, *query, &counts);
        cases.push_back(c);
      }
      EXPECT_GT(cases.size(), 300u);
      table.flush();
      contents.settle();
      for (const ContentCase& c : cases) {
        const uint32_t node = table.settled(contents.level(), c.answer.node);
        const Voxels ours = voxels_of(table, contents.level(), node);
        ASSERT_LE(c.answer.low, c.range.low);
        ASSERT_GE(c.answer.high, c.range.high);
        for (const int64_t offset : {c.answer.low, c.range.low, c.range.high, c.answer.high})
          ASSERT_EQ(ours, voxels_at(c.normal, rule, offset));
        ASSERT_EQ(c.answer.voxels, ours.count());
        const uint32_t w = c.answer.witness;
        if (c.answer.node != 0) {
          ASSERT_TRUE(ours[64 * (w & 1023) + 8 * (w >> 10 & 1023) + (w >> 20)]);
        }
      }
      // Cached contents outlive a flush.
      const uint64_t computed = counts.computed;
      const ContentCase& last = cases.back();
      const PlaneAnswer again =
          contents.find(contents.heights_of(last.normal.n), last.query, &counts);
      EXPECT_EQ(counts.computed, computed);
      EXPECT_EQ(again.node, table.settled(contents.level(), last.answer.node));
    }
  }
}

TEST(PlaneContents, LeaveEveryTieToTheMemo) {
  std::mt19937_64 random(2);
  MemoryBudget budget;
  NodeTable table(kContentLevels, &budget);
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    PlaneContents contents(kContentLevels, rule, &kernels(), &table);
    contents.allocate(PlaneContents::table_bytes(1 << 20));
    for (int i = 0; i < 20'000; ++i) {
      const Normal normal = draw_normal(random);
      const auto coordinate = [&] { return int64_t(random() % 8); };
      const OffsetRange voxel =
          voxel_range(normal, rule, {coordinate(), coordinate(), coordinate()});
      const PlaneHeights heights = contents.heights_of(normal.n);
      for (const int64_t tie : {voxel.low, voxel.high}) {
        ASSERT_FALSE(contents.query(heights, {tie, tie}));
        ASSERT_FALSE(contents.query(heights, {tie - 1, tie + 1}));
      }
    }
  }
}

TEST(PlaneContents, AnswerAlmostEveryPlaneAndShareTheContentsOfDifferentOnes) {
  std::mt19937_64 random(3);
  MemoryBudget budget;
  NodeTable table(kContentLevels, &budget);
  PlaneContents contents(kContentLevels, Rule::kConservative, &kernels(), &table);
  contents.allocate(PlaneContents::table_bytes(UINT64_MAX));
  PlaneMemoCounts counts;
  int answered = 0;
  for (int i = 0; i < 100'000; ++i) {
    // Normals within a degree of each other, none of them twice.
    const int64_t m = int64_t(1) << 28;
    const int64_t n[3] = {m / 2 + int64_t(random() % (1 << 22)), m / 3, m};
    const PlaneHeights heights = contents.heights_of(n);
    const int64_t offset = int64_t(random() % uint64_t(14 * m)) * kContentVoxel;
    if (const auto query = contents.query(heights, {offset, offset + 1})) {
      ++answered;
      contents.find(heights, *query, &counts);
    }
  }
  EXPECT_GT(answered, 99'900);
  EXPECT_GT(counts.hits, 50'000u);
}

TEST(PlaneContents, AnswerNothingWithoutMemoryOrFarFromTheCube) {
  MemoryBudget budget;
  NodeTable table(kContentLevels, &budget);
  PlaneContents contents(kContentLevels, Rule::kConservative, &kernels(), &table);
  const int64_t n[3] = {1, 2, 5};
  const PlaneHeights heights = contents.heights_of(n);
  const OffsetRange inside{kContentVoxel * 13 / 2 + 1, kContentVoxel * 13 / 2 + 1};
  EXPECT_EQ(PlaneContents::table_bytes(1000), 0u);
  EXPECT_FALSE(contents.query(heights, inside));
  contents.allocate(PlaneContents::table_bytes(1 << 20));
  EXPECT_TRUE(contents.query(heights, inside));
  constexpr int64_t kFar = int64_t(1) << 61;
  for (const OffsetRange& far : {OffsetRange{-kFar, -kFar}, {kFar, kFar}, {-kFar, kFar}})
    EXPECT_FALSE(contents.query(heights, far));
}

}  // namespace
}  // namespace svdag
