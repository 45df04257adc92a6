// Rank maps give the same indices in memory and spilled, whole or by windows, composed or not.
#include "builder/merge/rank_maps.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/temp_folder.h"

namespace svdag {
namespace {

class RankMapsTest : public ::testing::Test {
 protected:
  RankMaps filled(const std::vector<std::vector<uint32_t>>& maps, bool spilled) {
    std::vector<uint64_t> counts;
    for (const auto& map : maps) counts.push_back(map.size());
    RankMaps result(counts, spilled ? &scratch_ : nullptr, &budget_);
    for (size_t s = 0; s < maps.size(); ++s) {
      for (size_t rank = 0; rank < maps[s].size(); ++rank) result.set(s, rank, maps[s][rank]);
    }
    result.finish();
    return result;
  }
  // Every second index from `first` on: more than one block of the scratch file.
  static std::vector<uint32_t> ascending(uint32_t first, size_t count) {
    std::vector<uint32_t> map(count);
    for (size_t i = 0; i < count; ++i) map[i] = uint32_t(first + 2 * i);
    return map;
  }

  TempFolder temp_;
  MemoryBudget budget_{uint64_t(64) << 20};
  ScratchDir folder_{temp_.file("scratch")};
  Scratch scratch_{&folder_, &budget_};
};

TEST_F(RankMapsTest, InMemoryHoldWhatWasSet) {
  const std::vector<std::vector<uint32_t>> maps = {ascending(0, 5), {}, ascending(7, 3)};
  const RankMaps filled_maps = filled(maps, false);
  ASSERT_EQ(filled_maps.size(), 3U);
  EXPECT_FALSE(filled_maps.spilled());
  for (size_t s = 0; s < maps.size(); ++s) {
    for (size_t rank = 0; rank < maps[s].size(); ++rank)
      EXPECT_EQ(filled_maps.resident(s)[rank], maps[s][rank]);
  }
}

TEST_F(RankMapsTest, SpilledAreLoadedByAnyWindow) {
  const std::vector<uint32_t> map = ascending(3, 200'000);
  const RankMaps spilled = filled({{}, map}, true);
  EXPECT_EQ(spilled.count(0), 0U);
  EXPECT_EQ(spilled.count(1), map.size());
  const uint64_t n = map.size();
  for (const auto& [begin, end] : std::initializer_list<std::pair<uint64_t, uint64_t>>{
           {0, n}, {0, 1}, {n - 1, n}, {12'345, 99'999}, {65'536, 65'536}, {n - 5, n + 100}}) {
    const RankMap window = spilled.load(1, begin, end);
    ASSERT_EQ(window.indices.size(), std::min(end, n) - begin);
    for (uint64_t rank = begin; rank < std::min(end, n); ++rank) {
      ASSERT_TRUE(window.holds(rank));
      ASSERT_EQ(window[rank], map[rank]);
    }
    EXPECT_FALSE(window.holds(std::min(end, n)));
    EXPECT_FALSE(begin > 0 && window.holds(begin - 1));
  }
}

TEST_F(RankMapsTest, ComposedLeadFromTheMemberToTheOutput) {
  const std::vector<uint32_t> group = ascending(1, 150'000);
  std::vector<uint32_t> member(50'000);
  for (size_t i = 0; i < member.size(); ++i) member[i] = uint32_t(3 * i);
  RankMaps members = filled({member}, true);
  const RankMaps groups = filled({group}, true);
  RankMaps composed = RankMaps::without_sources(&scratch_, &budget_);
  composed.append_composed(&members, 0, groups, 0);
  const RankMap all = composed.load(0);
  ASSERT_EQ(all.indices.size(), member.size());
  for (size_t rank = 0; rank < member.size(); ++rank) ASSERT_EQ(all[rank], group[member[rank]]);
}

}  // namespace
}  // namespace svdag
