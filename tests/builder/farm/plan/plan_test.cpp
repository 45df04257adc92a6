// Plans: saving and loading, detection of damage, and the folder of a plan.
#include "builder/farm/plan/plan.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <numeric>
#include <optional>
#include <random>
#include <thread>

#include "builder/farm/plan/leaf_bins.h"
#include "streaming/spill/scratch_dir.h"
#include "tests/builder/farm/plans.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

class Plans : public ::testing::Test {
 protected:
  Plans() { write_stl(scene_, random_soup(20'000, 0.05, 1)); }
  PlanConfig config(size_t shards = 5) const {
    return plan_config(scene_, 9, folder_.file("plan"), shards);
  }

  TempFolder folder_;
  std::string scene_ = folder_.file("scene.stl");
};

TEST_F(Plans, AreLoadedAsSaved) {
  PlanConfig c = config();
  c.fan_in = 2;
  c.build.bounds = Box{{0.1, 0.1, 0.1}, {0.8, 0.9, 0.7}};
  const Plan saved = plan_of(c), loaded = load_plan(c.folder, true);
  EXPECT_EQ(loaded.hash, saved.hash);
  EXPECT_EQ(loaded.folder, saved.folder);
  EXPECT_EQ(loaded.description, saved.description);
  EXPECT_EQ(loaded.grid, saved.grid);
  EXPECT_EQ(loaded.counts.largest_snap, saved.counts.largest_snap);
  ASSERT_EQ(loaded.steps.size(), saved.steps.size());
  for (size_t i = 0; i < saved.steps.size(); ++i) {
    EXPECT_EQ(loaded.steps[i].name, saved.steps[i].name);
    EXPECT_EQ(loaded.steps[i].inputs, saved.steps[i].inputs);
    EXPECT_EQ(loaded.steps[i].cells.begin, saved.steps[i].cells.begin);
    EXPECT_EQ(loaded.steps[i].cells.end, saved.steps[i].cells.end);
    EXPECT_EQ(loaded.steps[i].predicted.budget, saved.steps[i].predicted.budget);
  }
  ASSERT_EQ(loaded.bins.size(), saved.bins.size());
  for (size_t i = 0; i < saved.bins.size(); ++i) {
    EXPECT_EQ(loaded.bins[i].range, saved.bins[i].range);
    EXPECT_EQ(loaded.bins[i].stream.blocks, saved.bins[i].stream.blocks);
  }
}

TEST_F(Plans, BinsAreSortedAndContiguous) {
  const Plan plan = plan_of(config(50));
  ASSERT_GT(plan.bins.size(), 8u);
  uint32_t next = 0;
  uint64_t at = 0;
  for (const TriangleBin& bin : plan.bins) {
    EXPECT_GE(bin.range.begin, at);
    at = bin.range.end;
    for (const uint32_t block : bin.stream.blocks) EXPECT_EQ(block, next++);
  }
}

TEST_F(Plans, ShardsReadFewTrianglesThatOthersRead) {
  const Plan plan = plan_of(config(4));
  uint64_t read = 0;
  for (const PlanStep& step : plan.steps) {
    if (!step.is_shard()) continue;
    for (const TriangleBin& bin : bins_of(plan.bins, step.cells, plan.grid.levels))
      read += bin.triangles;
  }
  EXPECT_LT(read, 2 * plan.counts.scene.triangles);
}

TEST_F(Plans, DoNotChange) {
  plan_of(config());
  EXPECT_SVDAG_ERROR(plan_of(config()), ExitCode::kUsage,
                     "contains a plan, which cannot be changed");
}

// The planner waits for the scratch folder: its owner may have finished a plan.
TEST_F(Plans, DoNotReplaceOneThatAnotherProcessJustFinished) {
  const std::string folder = config().folder;
  std::filesystem::create_directory(folder);
  std::optional<ScratchDir> others(folder + "/plan.scratch");
  const std::jthread end([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    folder_.write("plan/plan.json", "theirs");
    others.reset();
  });
  EXPECT_SVDAG_ERROR(plan_of(config()), ExitCode::kUsage,
                     "contains a plan, which cannot be changed");
  EXPECT_EQ(folder_.read("plan/plan.json"), "theirs");
}

TEST_F(Plans, ReportWhyTheirFolderCannotBeCreated) {
  PlanConfig lost = config();
  lost.folder = folder_.file("none/plan");
  EXPECT_SVDAG_ERROR(plan_of(lost), ExitCode::kOutput,
                     "the folder cannot be created: no such file or folder");
}

TEST_F(Plans, RejectAnOutputWhoseNameIsTooLong) {
  PlanConfig endless = config();
  endless.output = std::string(256, 'x');
  EXPECT_SVDAG_ERROR(plan_of(endless), ExitCode::kOutput,
                     "the file name is too long: choose a shorter one");
  EXPECT_FALSE(std::filesystem::exists(endless.folder)) << "nothing is left";
}

TEST_F(Plans, IdentifyTheirInputsByContent) {
  const Plan plan = plan_of(config());
  ASSERT_EQ(plan.inputs.size(), 1u);
  EXPECT_EQ(plan.inputs[0].path, absolute_path(scene_));
  EXPECT_EQ(plan.inputs[0].bytes, std::filesystem::file_size(scene_));
  EXPECT_NE(plan.description.find(plan.inputs[0].hash), std::string::npos);
}

TEST_F(Plans, ThatAreDamagedAreRejected) {
  plan_of(config());
  const std::string json = folder_.file("plan/plan.json"), index = folder_.file("plan/index");
  const std::string text = read_bytes(json), bytes = read_bytes(index);
  const auto write = [](const std::string& path, std::string content) {
    if (path.ends_with(".json")) seal_plan(&content);
    std::ofstream(path, std::ios::binary) << content;
  };
  for (const size_t kept : {size_t(0), text.size() / 2, text.size() - 3}) {
    write(json, text.substr(0, kept));
    EXPECT_SVDAG_ERROR(load_plan(folder_.file("plan"), true), ExitCode::kBadInput, "plan.json");
  }
  std::string moved = text;
  const size_t end = moved.find("\"end\": ");
  moved.replace(end, 8, "\"end\": 99999999999");
  write(json, moved);
  EXPECT_SVDAG_ERROR(load_plan(folder_.file("plan"), true), ExitCode::kBadInput, "not in the grid");
  write(json, text);
  std::string outside = text;
  const size_t output = outside.find("\"output\": \"runs/");
  outside.replace(output, 17, "\"output\": \"../up/");
  write(json, outside);
  EXPECT_SVDAG_ERROR(load_plan(folder_.file("plan"), true), ExitCode::kBadInput,
                     "writes outside the plan folder");
  std::string renamed = text;
  renamed.replace(renamed.find("\"name\": \"shard-1\""), 17, "\"name\": \"s\"");
  write(json, renamed);
  EXPECT_SVDAG_ERROR(load_plan(folder_.file("plan"), true), ExitCode::kBadInput,
                     "its name does not begin with shard-");
  std::string threads = text;
  threads.replace(threads.find("\"threads\": "), 11, "\"threads\": 9999");
  write(json, threads);
  EXPECT_SVDAG_ERROR(load_plan(folder_.file("plan"), true), ExitCode::kBadInput,
                     "an invalid number of threads (9999");
  std::string huge = text;
  huge.replace(huge.find("\"voxel_size\": "), 14, "\"voxel_size\": -");
  write(json, huge);
  EXPECT_SVDAG_ERROR(load_plan(folder_.file("plan"), true), ExitCode::kBadInput, "invalid grid");
  std::string kind = text;
  kind.replace(kind.find("\"kind\": \"box\""), 13, "\"kind\": \"hexagons\"");
  write(json, kind);
  EXPECT_SVDAG_ERROR(load_plan(folder_.file("plan"), true), ExitCode::kBadInput,
                     "plan.json: unknown kind of grid (hexagons)");
  const std::pair<const char*, const char*> edits[] = {{"\"conservative\"", "\"exact\""},
                                                       {"\"conservative\"", "\"thin\""},
                                                       {"\"levels\": 9", "\"levels\": 10"}};
  for (const auto& [before, after] : edits) {
    std::string other = text;
    ASSERT_NE(other.find(before), std::string::npos) << before;
    other.replace(other.find(before), std::strlen(before), after);
    write(json, other);
    EXPECT_SVDAG_ERROR(load_plan(folder_.file("plan"), true), ExitCode::kBadInput, "rule");
  }
  write(json, text);
  std::string flipped = bytes;
  flipped[flipped.size() / 2] ^= 1;
  write(index, flipped);
  EXPECT_SVDAG_ERROR(load_plan(folder_.file("plan"), true), ExitCode::kBadInput, "index");
  EXPECT_SVDAG_ERROR(load_plan(folder_.path(), true), ExitCode::kBadInput, "not a plan folder");
}

TEST_F(Plans, WithNumbersThatDoNotFitAreDamaged) {
  plan_of(config());
  const std::string json = folder_.file("plan/plan.json"), text = read_bytes(json);
  const std::vector<std::pair<std::string, std::string>> numbers = {
      {"levels", "4294967305"},  // the valid value 9 if truncated to 32 bits
      {"levels", "9.0"},
      {"triangles", "1e24"},
      {"memory_bytes", "-1"},
      {"threads", "1.5"},
      {"bytes", "18446744073709551616"}};
  for (const auto& [key, number] : numbers) {
    const size_t value = text.find("\"" + key + "\": ") + key.size() + 4;
    std::string changed = text;
    changed.replace(value, changed.find_first_of(",}\n", value) - value, number);
    seal_plan(&changed);
    std::ofstream(json, std::ios::binary) << changed;
    EXPECT_SVDAG_ERROR(load_plan(folder_.file("plan"), true), ExitCode::kBadInput, "out of range");
  }
}

// Whatever digit, letter or space of it is changed.
TEST_F(Plans, ThatWereEditedAreRejected) {
  plan_of(config());
  const std::string json = folder_.file("plan/plan.json"), text = read_bytes(json);
  load_plan(folder_.file("plan"), true);
  for (size_t i = 0; i < text.size(); ++i) {
    std::string edited = text;
    edited[i] = text[i] == '1' ? '2' : text[i] == ' ' ? '\t' : text[i] == 'a' ? 'b' : '1';
    std::ofstream(json, std::ios::binary) << edited;
    EXPECT_THROW(load_plan(folder_.file("plan"), true), Error) << edited.substr(i, 20);
  }
}

TEST_F(Plans, WithRandomBytesAreLoadedOrRejected) {
  plan_of(config());
  const std::string json = folder_.file("plan/plan.json"), text = read_bytes(json);
  std::mt19937 random(5);
  int refused = 0;
  for (int run = 0; run < 2000; ++run) {
    std::string other = text;
    for (int k = 0; k < 3; ++k)
      other[random() % other.size()] = "0-9.e\"[]{},:/\x01"[random() % 15];
    seal_plan(&other);
    std::ofstream(json, std::ios::binary) << other;
    try {
      load_plan(folder_.file("plan"), true);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST_F(Plans, PredictResourcesWithinTheLimits) {
  PlanConfig c = config(3);
  c.step_threads = 2;
  c.build.memory = uint64_t(100) << 20;
  for (const PlanStep& step : plan_of(c).steps) {
    EXPECT_EQ(step.threads, step.is_shard() ? 2u : 1u);
    EXPECT_GE(step.predicted.budget, uint64_t(64) << 20);
    EXPECT_LE(step.predicted.budget, uint64_t(100) << 20);
    EXPECT_EQ(step.predicted.memory, step.predicted.budget + kBesideBudget);
    EXPECT_GT(step.predicted.cpu, 0);
  }
}

TEST_F(Plans, DryRunsLeaveNoFiles) {
  PlanConfig c = config(1);
  c.folder.clear();
  c.build.output = folder_.file("out.svdag");
  const Plan plan = plan_of(c);
  EXPECT_EQ(plan.steps.size(), 2u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(Plans, DryRunsKeepAnUnfinishedBake) {
  PlanConfig c = config(1);
  c.folder.clear();
  c.build.output = folder_.file("out.svdag");
  std::filesystem::create_directory(folder_.file("scratch"));
  for (const std::string& under : {std::string(), folder_.file("scratch")}) {
    c.build.scratch = under;
    const std::string path = ScratchDir::path_for(c.build.output, under);
    {
      ScratchDir bake(path);
      bake.create("journal");
      bake.keep();
    }
    EXPECT_EQ(plan_of(c).steps.size(), 2u);
    EXPECT_TRUE(ScratchDir(path).has("journal"));
    EXPECT_FALSE(std::filesystem::exists(path));
  }
  // The scene, and --scratch.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.file("scratch")));
}

TEST_F(Plans, KeepAnUnfinishedBakeWithTheSameScratchFolder) {
  PlanConfig c = config();
  std::filesystem::create_directory(c.folder);
  {
    ScratchDir bake(ScratchDir::path_for(c.folder + "/plan", ""));
    bake.create("journal");
    bake.keep();
  }
  EXPECT_SVDAG_ERROR(plan_of(c), ExitCode::kUsage, "contains an unfinished bake");
  EXPECT_TRUE(ScratchDir(c.folder + "/plan.scratch").has("journal"));
}

}  // namespace
}  // namespace svdag
