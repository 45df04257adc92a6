// A journal is read back as it was written, or rejected before it is used.
#include "builder/bake/saved_bake.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/expect_error.h"

namespace svdag {
namespace {

JournalRecord record_of(SavedKind kind, const RecordWriter& record) {
  return {uint32_t(kind), {record.bytes().begin(), record.bytes().end()}};
}

Grid small_grid() {
  Grid grid;
  grid.levels = 5;
  grid.voxel_size = 0.25;
  grid.selection = grid.whole();
  return grid;
}

SplitScene small_split() {
  SplitScene split;
  split.counts.scene.triangles = 18;
  split.counts.scene.quantisation = 0.5;
  split.counts.scene.invalid = 2;
  split.counts.scene.cut = 8;
  split.counts.scene.undeformed = 3;
  const auto image = std::make_shared<AlphaImage>(2, 1, std::vector<uint8_t>{0, 200});
  split.cut_outs = {{image, Wrap::kClamp, Wrap::kMirror, true, 100}, {image}};
  split.counts.clipped = 4;
  split.counts.outside = 5;
  split.counts.degenerate = 6;
  split.counts.largest_snap = 0.125;
  for (const int64_t z : {0, 1}) {
    const Cube cube{1, {0, 0, z}};
    split.bins.push_back({cube, morton_range(cube, 5), 9, {uint64_t(1 + z), 640, {uint32_t(z)}}});
  }
  return split;
}

BakedRun small_run() {
  BakedRun baked;
  baked.run.bricks.spilled = {3, 16, {0}};
  baked.run.nodes.resize(3);
  for (uint32_t level = 0; level < 3; ++level)
    baked.run.nodes[level].spilled = {4 + level, 64, {1 + level}};
  baked.roots = {{5, 1, 0, 1}, {0, 3, 0, 0}};
  baked.voxels = 7;
  baked.finished = {{0, 512}, {4096, 32768}};
  return baked;
}

std::vector<JournalRecord> small_journal() {
  return {record_of(SavedKind::kBake, bake_record("rule: thin\n", small_grid(), 16384)),
          record_of(SavedKind::kSplit, split_record(small_split())),
          record_of(SavedKind::kRun, run_record(small_run())), record_of(SavedKind::kSession, {})};
}

SavedBake read(const std::vector<JournalRecord>& records) {
  return read_saved(records, "a/journal");
}

TEST(SavedBake, IsReadAsItWasWritten) {
  const SavedBake saved = read(small_journal());
  EXPECT_EQ(saved.description, "rule: thin\n");
  EXPECT_EQ(saved.grid, small_grid());
  EXPECT_EQ(saved.block_bytes, 16384U);
  EXPECT_EQ(saved.sessions, 1U);
  EXPECT_EQ(saved.triangle_blocks, 2U);
  EXPECT_EQ(saved.run_blocks, 4U);
  ASSERT_TRUE(saved.split);
  const SplitCounts& counts = saved.split->counts;
  EXPECT_EQ(counts.scene.triangles, 18U);
  EXPECT_EQ(counts.scene.quantisation, 0.5);
  EXPECT_EQ(counts.scene.invalid, 2U);
  EXPECT_EQ(counts.scene.undeformed, 3U);
  EXPECT_EQ(counts.clipped, 4U);
  EXPECT_EQ(counts.outside, 5U);
  EXPECT_EQ(counts.degenerate, 6U);
  EXPECT_EQ(counts.largest_snap, 0.125);
  ASSERT_EQ(saved.split->bins.size(), 2U);
  EXPECT_EQ(saved.split->bins[1].range, (MortonRange{4096, 8192}));
  EXPECT_EQ(saved.split->bins[1].stream.blocks, (std::vector<uint32_t>{1}));
  ASSERT_EQ(saved.runs.size(), 1U);
  EXPECT_EQ(saved.runs[0].roots[0].morton, 5U);
  EXPECT_EQ(saved.runs[0].finished, small_run().finished);
  EXPECT_EQ(saved.runs[0].run.nodes[2].spilled->number, 6U);
}

// What was spilled for a finished bake is not needed for its colours.
TEST(SavedBake, AFinishedBakeHasCountsAndColoursOnly) {
  auto records = small_journal();
  records.push_back(record_of(SavedKind::kBaked, baked_record(small_split().counts)));
  records.push_back(record_of(SavedKind::kColours, colours_record(64, {9, 48, {2}})));
  records.push_back(record_of(SavedKind::kColours, colours_record(512, {})));
  const SavedBake saved = read(records);
  EXPECT_TRUE(saved.has_work());
  EXPECT_FALSE(saved.split);
  EXPECT_TRUE(saved.runs.empty());
  EXPECT_EQ(saved.baked->scene.triangles, 18U);
  EXPECT_EQ(saved.coloured, 512U);
  ASSERT_EQ(saved.colours.size(), 2U);
  EXPECT_EQ(saved.colours[0].number, 9U);
  EXPECT_EQ(saved.triangle_blocks, 0U);
  EXPECT_EQ(saved.run_blocks, 3U);
  const auto with = [&](const RecordWriter& colours) {
    auto changed = records;
    changed.push_back(record_of(SavedKind::kColours, colours));
    return changed;
  };
  EXPECT_SVDAG_ERROR(read(with(colours_record(511, {}))), ExitCode::kOutput, "not in the grid");
  EXPECT_SVDAG_ERROR(read(with(colours_record(32769, {}))), ExitCode::kOutput, "not in the grid");
  EXPECT_SVDAG_ERROR(read(with(colours_record(512, {9, 17, {3}}))), ExitCode::kOutput,
                     "within an entry");
  records.push_back(records[4]);
  EXPECT_SVDAG_ERROR(read(records), ExitCode::kOutput, "baked twice");
}

TEST(SavedBake, AJournalWithoutRecordsHasNone) {
  EXPECT_EQ(read({}).block_bytes, 0U);
}

// Records have no names: without the number, those of another layout would be damaged, or be read
// as something else.
TEST(SavedBake, OfAnotherLayoutIsKnownAsSuch) {
  auto records = small_journal();
  ++reinterpret_cast<uint8_t&>(records[0].payload[0]);
  EXPECT_SVDAG_ERROR(read(records), ExitCode::kUsage,
                     "a/journal: is of another version of svdag: discard it with --restart");
  // The layout before there was a number: the length of the description, the description.
  records[0].payload.erase(records[0].payload.begin(), records[0].payload.begin() + 4);
  EXPECT_SVDAG_ERROR(read(records), ExitCode::kUsage, "another version");
}

TEST(SavedBake, EveryOtherLengthIsRefused) {
  for (size_t which = 0; which < 4; ++which) {
    const std::vector<std::byte> whole = small_journal()[which].payload;
    for (size_t length = 0; length < whole.size(); ++length) {
      auto records = small_journal();
      records[which].payload.resize(length);
      EXPECT_SVDAG_ERROR(read(records), ExitCode::kOutput, "a/journal: is damaged");
    }
    auto records = small_journal();
    records[which].payload.push_back({});
    EXPECT_SVDAG_ERROR(read(records), ExitCode::kOutput, "too long");
  }
}

TEST(SavedBake, AnyWordMayBeAnythingAndNothingLargeIsMadeOfIt) {
  int read_all_the_same = 0, refused = 0;
  for (size_t which = 0; which < 3; ++which) {
    const size_t size = small_journal()[which].payload.size();
    for (const size_t width : {4, 8}) {
      for (size_t at = 0; at + width <= size; ++at) {
        for (const uint64_t value : {uint64_t(0), uint64_t(1), uint64_t(1) << 31, UINT32_MAX + 0UL,
                                     uint64_t(1) << 63, UINT64_MAX}) {
          auto records = small_journal();
          std::memcpy(records[which].payload.data() + at, &value, width);
          try {
            const SavedBake saved = read(records);
            ++read_all_the_same;
            EXPECT_TRUE(saved.grid.is_valid());
            EXPECT_LE(saved.split->bins.size(), 2U);
            for (const SubDagRoot& root : saved.runs[0].roots) EXPECT_LT(root.level, 4);
          } catch (const Error& error) {
            const bool layout = which == 0 && at < 4;
            EXPECT_TRUE(error.code() == ExitCode::kOutput ||
                        (layout && error.code() == ExitCode::kUsage))
                << error.what();
            ++refused;
          }
        }
      }
    }
  }
  EXPECT_GT(read_all_the_same, 500);  // sums, times, the text of the description
  EXPECT_GT(refused, 2000);
}

TEST(SavedBake, ItSaysWhatIsWrong) {
  const auto run_with = [](auto change) {
    BakedRun baked = small_run();
    change(&baked);
    auto records = small_journal();
    records[2] = record_of(SavedKind::kRun, run_record(baked));
    return records;
  };
  using B = BakedRun*;
  EXPECT_SVDAG_ERROR(read(run_with([](B b) { b->roots[0].rank = 2; })), ExitCode::kOutput,
                     "a root has no node");
  EXPECT_SVDAG_ERROR(read(run_with([](B b) { b->roots[1].level = 4; })), ExitCode::kOutput,
                     "a root is not in the grid");
  EXPECT_SVDAG_ERROR(read(run_with([](B b) { b->roots[0].morton = 8; })), ExitCode::kOutput,
                     "a root is not in the grid");
  EXPECT_SVDAG_ERROR(read(run_with([](B b) { b->finished[1].end = 32769; })), ExitCode::kOutput,
                     "a run is not in the grid");
  EXPECT_SVDAG_ERROR(read(run_with([](B b) { b->run.nodes.pop_back(); })), ExitCode::kOutput,
                     "other levels than the grid");
  EXPECT_SVDAG_ERROR(read(run_with([](B b) { b->run.nodes[1].spilled->bytes = 33; })),
                     ExitCode::kOutput, "within a node");
  EXPECT_SVDAG_ERROR(read(run_with([](B b) { b->run.bricks.spilled->bytes = 1 << 20; })),
                     ExitCode::kOutput, "impossible size");
  auto records = small_journal();
  records[3].kind = 7;
  EXPECT_SVDAG_ERROR(read(records), ExitCode::kOutput, "unknown kind");
  records = small_journal();
  std::swap(records[0], records[1]);
  EXPECT_SVDAG_ERROR(read(records), ExitCode::kOutput, "does not begin with the bake");
}

}  // namespace
}  // namespace svdag
