// The disk space of a bake is reported before it is used.
#include "builder/workspace/disk_need.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "builder/split/packed_triangles.h"
#include "tests/builder/bakes.h"
#include "tests/expect_error.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {


TEST(DiskNeed, RefusesOnlyWhatIsCertainNotToFit) {
  const TempFolder directory;
  MemoryBudget budget;
  ScratchDir folder(directory.file("scratch"));
  Scratch scratch(&folder, &budget);
  DiskNeed need(&scratch);
  const uint64_t free = folder.free_bytes();
  need.expect_triangles(1000, 2000);  // they stay in memory
  EXPECT_EQ(need.estimate(), 0U);
  need.expect_triangles(100'000, 2000);
  EXPECT_GT(need.estimate(), 100'000U * 15);
  EXPECT_SVDAG_ERROR(need.expect_triangles(free, 2000), ExitCode::kOutput, "only");
  need.expect_spilled(100'000, 1000, 300'000);  // 300 bytes each
  EXPECT_EQ(need.estimate(), 100'000U * 300);
  EXPECT_SVDAG_ERROR(need.expect_spilled(100'000, 1000, free / 10), ExitCode::kOutput, "only");
  DiskNeed records(&scratch);
  records.expect_records(kMiB, kMiB, "voxels");  // they stay in memory
  EXPECT_EQ(records.estimate(), 0U);
  records.expect_records(free / 2, kMiB, "voxels");
  EXPECT_EQ(records.estimate(), free / 2);
  EXPECT_SVDAG_ERROR(records.expect_records(2 * free, kMiB, "voxels"), ExitCode::kOutput, "voxels");
  DiskNeed runs(&scratch);
  runs.expect_runs(free, 0.1);  // too early to tell
  runs.expect_runs(free / 4, 0.5);
  EXPECT_EQ(runs.estimate(), free / 4 * 2);
  EXPECT_SVDAG_ERROR(runs.expect_runs(4 * free, 0.5), ExitCode::kOutput, "free");
}

TEST(DiskNeed, RefusesAnOutputThatCannotFit) {
  const TempFolder folder;
  MemoryBudget budget;
  ScratchDir scratch_folder(folder.file("scratch"));
  Scratch scratch(&scratch_folder, &budget);
  const DiskNeed need(&scratch);
  const std::string output = folder.file("out.svdag");
  EXPECT_NO_THROW(need.expect_output(output, kMiB));
  EXPECT_SVDAG_ERROR(need.expect_output(output, 2 * scratch_folder.free_bytes()), ExitCode::kOutput,
                     "out.svdag: needs at least");
}

// In double the share of all of them may be a byte less than what there is.
TEST(DiskNeed, IsNeverLessThanWhatWasSpilled) {
  const TempFolder directory;
  MemoryBudget budget;
  ScratchDir folder(directory.file("scratch"));
  Scratch scratch(&folder, &budget);
  DiskNeed need(&scratch);
  EXPECT_NO_THROW(need.expect_spilled(177'781'662, 177'781'662, 107'011'787));
  EXPECT_EQ(need.estimate(), 107'011'787U);
}

// A triangle that crosses the grid takes more than its corners: it is in many bins.
TEST(DiskNeed, IsThatOfLargeTrianglesToo) {
  const TempFolder folder;
  write_stl(folder.file("scene.stl"), random_soup(8000, 4, 19));
  BuildConfig config = config_for(folder.file("scene.stl"), folder.file("out.svdag"), 7);
  config.memory = 10 * kMiB;
  ASSERT_LT(8000 * PackedTriangles::kMinBytes, config.memory / 4);
  const BuildReport report = bake(config);
  EXPECT_GT(report.scratch.written, 4 * 8000 * sizeof(LatticeTriangle));
  EXPECT_GT(report.scratch.estimated, report.scratch.written / 2);
  EXPECT_LT(report.scratch.estimated, report.scratch.written * 2);
}

// Triangles that miss the part are counted with the others, and take nothing, anywhere in the file
// they stand.
class DiskNeedOfAPart : public ::testing::TestWithParam<bool> {};

TEST_P(DiskNeedOfAPart, IsThatOfItsTriangles) {
  const TempFolder folder;
  auto soup = random_soup(100'000, 0.05, 23);
  if (GetParam())  // those of the part first
    std::stable_partition(soup.begin(), soup.end(),
                          [](const Triangle& t) { return t.v[0].x < 0.5 && t.v[0].y < 0.5; });
  write_stl(folder.file("scene.stl"), soup);
  BuildConfig config = config_for(folder.file("scene.stl"), folder.file("out.run"), 8);
  config.memory = 4 * kMiB;
  config.part = GridPart::share(1, 4);
  const BuildReport report = bake(config);
  EXPECT_GT(report.split.outside, 50'000U);
  EXPECT_GT(report.scratch.written, 0U);
  EXPECT_LT(report.scratch.estimated, report.scratch.written * 2);
}

INSTANTIATE_TEST_SUITE_P(Order, DiskNeedOfAPart, ::testing::Bool());

// All triangles of the scene would not fit in memory; those of a part may.
TEST(DiskNeed, OfAPartThatFitsIsNothing) {
  const TempFolder folder;
  write_stl(folder.file("scene.stl"), random_soup(100'000, 0.02, 23));
  BuildConfig config = config_for(folder.file("scene.stl"), folder.file("out.run"), 7);
  config.memory = 16 * kMiB;
  config.part = GridPart::share(1, 16);
  ASSERT_GT(100'000 * PackedTriangles::kMinBytes, config.memory / 4);
  const BuildReport report = bake(config);
  EXPECT_EQ(report.scratch.written, 0U);
  EXPECT_EQ(report.scratch.estimated, 0U);
}

}  // namespace
}  // namespace svdag
