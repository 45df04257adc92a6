// The merge of one level: the sorted union of its sources and their maps, whatever the sources are
// held in, however small the pieces, and in whatever order the workers run.
#include "builder/merge/merge_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <random>
#include <thread>

#include "tests/temp_folder.h"

namespace svdag {
namespace {

// A list of bricks with indices 3, 6, 9, ..., which is full at `limit` bricks.
struct BrickList {
  void encode(std::span<const Brick> keys, LevelPiece* piece) const {
    for (const Brick brick : keys) piece->add(key_of(brick), 3 * piece->indices.size());
    const auto bytes = std::as_bytes(keys);
    piece->bytes.insert(piece->bytes.end(), bytes.begin(), bytes.end());
  }
  uint32_t append(LevelPiece* piece) {
    const size_t first = bricks.size();
    bricks.resize(first + piece->indices.size());
    std::memcpy(bricks.data() + first, piece->bytes.data(), piece->bytes.size());
    if (bricks.size() > limit) throw Error(ExitCode::kOutput, "the disk is full");
    return uint32_t(3 * (first + 1));
  }
  void store(LevelPiece* piece) { stored += piece->indices.size(); }

  size_t limit = SIZE_MAX;
  std::vector<Brick> bricks;
  std::atomic<size_t> stored = 0;
};

class MergeLevelTest : public ::testing::Test {
 protected:
  // Ascending numbers below `end`, each with probability `share`.
  std::vector<Brick> draw(Brick end, double share) {
    std::vector<Brick> keys;
    for (Brick key = 1; key < end; ++key) {
      if (double(random_() % 1'000'000) < share * 1'000'000) keys.push_back(key);
    }
    return keys;
  }
  SpillStream spill(const std::vector<Brick>& keys) {
    SpillWriter writer(scratch_.transient(), scratch_.new_streams(), &large_);
    writer.append(std::as_bytes(std::span(keys)));
    return writer.finish();
  }

  // Merges with every second source in blocks, and expects the union and the maps to it.
  void expect_merged(const std::vector<std::vector<Brick>>& sources, MemoryBudget* budget,
                     bool spill_maps, Executor* executor) {
    std::vector<SpillStream> streams(sources.size());
    std::vector<LevelInput<Brick>> inputs;
    for (size_t s = 0; s < sources.size(); ++s) {
      if (s % 2 != 0) streams[s] = spill(sources[s]);
      inputs.push_back(s % 2 != 0 ? spilled_input<Brick>(scratch_.transient(), streams[s], &large_)
                                  : LevelInput<Brick>{sources[s], {}, 0, nullptr});
    }
    BrickList merged;
    std::atomic<uint64_t> taken = 0, placed = 0;
    const auto progress = [&](uint64_t of_inputs, uint64_t of_output) {
      taken += of_inputs;
      placed += of_output;
    };
    const RankMaps maps = merge_at_once<Brick>(inputs, &merged, progress,
                                               spill_maps ? &scratch_ : nullptr, budget, executor);
    std::vector<Brick> expected;
    for (const auto& source : sources)
      expected.insert(expected.end(), source.begin(), source.end());
    ASSERT_EQ(taken, expected.size());
    std::sort(expected.begin(), expected.end());
    expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
    ASSERT_EQ(merged.bricks, expected);
    ASSERT_EQ(merged.stored, expected.size());
    ASSERT_EQ(placed, expected.size());
    ASSERT_EQ(maps.size(), sources.size());
    for (size_t s = 0; s < sources.size(); ++s) {
      RankMap loaded;
      if (spill_maps) loaded = maps.load(s);
      const RankMap& map = spill_maps ? loaded : maps.resident(s);
      ASSERT_EQ(map.indices.size(), sources[s].size());
      for (size_t rank = 0; rank < sources[s].size(); ++rank)
        ASSERT_EQ(expected[map[rank] / 3 - 1], sources[s][rank]);
    }
  }

  TempFolder temp_;
  MemoryBudget large_, small_{uint64_t(8) << 20};
  ScratchDir folder_{temp_.file("scratch")};
  Scratch scratch_{&folder_, &large_};
  std::mt19937_64 random_{1};
};

TEST_F(MergeLevelTest, GivesTheUnionAndTheMapsInAnySchedule) {
  ParallelExecutor shuffled(4, [](size_t index) {
    std::this_thread::sleep_for(std::chrono::microseconds(200 * ((index * 7) % 5)));
  });
  SequentialExecutor sequential;
  ParallelExecutor parallel(2);
  const std::vector<std::vector<std::vector<Brick>>> cases = {
      {},
      {{}},
      {{}, {}, {5}},
      {{7}, {7}, {7}},
      {draw(20'000, 0.5), draw(20'000, 0.5)},
      {draw(90'000, 0.9), draw(1000, 0.1), {89'999}, draw(90'000, 0.4), {}, draw(90'000, 0.01)},
      {draw(50'000, 1), draw(50'000, 1), draw(50'000, 1)}};
  for (const auto& sources : cases) {
    for (MemoryBudget* budget : {&large_, &small_}) {
      for (const bool spill_maps : {false, true}) {
        expect_merged(sources, budget, spill_maps, &sequential);
        expect_merged(sources, budget, spill_maps, &parallel);
        expect_merged(sources, budget, spill_maps, &shuffled);
      }
    }
  }
}

TEST_F(MergeLevelTest, PassesOnTheErrorOfTheOutput) {
  ParallelExecutor parallel(4);
  const std::vector<Brick> keys = draw(200'000, 1);
  const std::vector<LevelInput<Brick>> inputs(2, {keys, {}, 0, nullptr});
  BrickList full;
  full.limit = 150'000;
  EXPECT_THROW(merge_at_once<Brick>(
                   inputs, &full, [](uint64_t, uint64_t) {}, nullptr, &large_, &parallel),
               Error);
}

TEST_F(MergeLevelTest, PassesOnTheErrorOfASource) {
  struct Damaged : BlockSource {
    std::vector<Brick> block;
    int blocks = 0;
    std::span<std::byte> next() override {
      if (++blocks == 5) throw Error(ExitCode::kBadInput, "is damaged");
      block.clear();
      for (Brick brick = 1; brick <= 1000; ++brick) block.push_back(Brick(blocks) * 1000 + brick);
      return std::as_writable_bytes(std::span(block));
    }
  };
  const std::vector<Brick> keys = draw(100'000, 1);
  const std::vector<LevelInput<Brick>> inputs = {
      {keys, {}, 0, nullptr}, {{}, [] { return std::make_unique<Damaged>(); }, 80'000, nullptr}};
  ParallelExecutor parallel(4);
  for (int i = 0; i < 20; ++i) {
    BrickList output;
    EXPECT_THROW(merge_at_once<Brick>(
                     inputs, &output, [](uint64_t, uint64_t) {}, nullptr, &large_, &parallel),
                 Error);
  }
}

}  // namespace
}  // namespace svdag
