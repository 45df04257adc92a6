// The steps of a plan give the bytes of one bake, keep valid outputs, and reject foreign inputs.
#include "builder/farm/engines/run_step.h"

#include <gtest/gtest.h>

#include <map>

#include "builder/bake/checkpoint.h"
#include "builder/bake/description.h"
#include "tests/builder/farm/plans.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

class Steps : public ::testing::Test {
 protected:
  // Bakes the scene without a plan: the expected result.
  void prepare(const std::vector<Triangle>& triangles, int levels) {
    levels_ = levels;
    write_stl(scene_, triangles);
    const BuildConfig config = config_for(scene_, folder_.file("one.svdag"), levels);
    bake(config);
    expected_ = read_bytes(config.output);
  }
  PlanConfig config(const std::string& name, size_t shards) const {
    return plan_config(scene_, levels_, folder_.file(name), shards);
  }
  static void write(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  }

  TempFolder folder_;
  std::string scene_ = folder_.file("scene.stl");
  std::string expected_;
  int levels_ = 0;
};

TEST_F(Steps, GiveTheBytesOfOneBakeWithoutTheScene) {
  for (const auto& [triangles, levels] :
       {std::pair(random_soup(20'000, 0.1, 1), 8), std::pair(bumpy_sphere(60), 9),
        std::pair(boxes_and_quad(200, 2), 9), std::pair(random_soup(50, 0.5, 3), 3)}) {
    for (const auto& [shards, fan_in] : {std::pair(1, 16), std::pair(3, 2), std::pair(20, 3)}) {
      prepare(triangles, levels);
      const std::string name = "plan" + std::to_string(shards);
      std::filesystem::remove_all(folder_.file(name));
      PlanConfig c = config(name, size_t(shards));
      c.fan_in = size_t(fan_in);
      const Plan plan = load_plan(plan_of(c).folder, true);
      std::filesystem::remove(scene_);
      do_steps(plan);
      EXPECT_EQ(read_bytes(plan.path("scene.svdag")), expected_) << shards << " shards";
    }
  }
}

TEST_F(Steps, GiveTheBytesOfOneBakeWithRuleBoundsAndLittleMemory) {
  prepare(bumpy_sphere(60), 8);
  BuildConfig one = config_for(scene_, folder_.file("one.svdag"), 8);
  one.bounds = Box{{-0.5, -0.9, -0.4}, {0.8, 0.2, 0.7}};
  one.rule = Rule::kThin;
  bake(one);
  PlanConfig c = config("plan", 6);
  c.build.bounds = one.bounds;
  c.build.rule = one.rule;
  const Plan plan = plan_of(c);
  StepConfig little;
  little.memory = uint64_t(4) << 20;
  little.scratch = folder_.path();
  for (const PlanStep& step : plan.steps) do_step(plan, step, little);
  EXPECT_EQ(read_bytes(plan.path("scene.svdag")), read_bytes(one.output));
}

TEST_F(Steps, KeepValidOutputsAndReplaceOthers) {
  prepare(bumpy_sphere(40), 8);
  const Plan plan = plan_of(config("plan", 2));
  do_steps(plan);
  for (const PlanStep& step : plan.steps) {
    const std::string path = plan.path(step.output), bytes = read_bytes(path);
    EXPECT_TRUE(do_step(plan, step).done_before);
    std::string flipped = bytes;
    flipped[bytes.size() * 2 / 3] ^= 1;
    for (const std::string& other : {std::string(), bytes.substr(0, bytes.size() / 2), flipped}) {
      write(path, other);
      EXPECT_FALSE(do_step(plan, step).done_before);
      EXPECT_EQ(read_bytes(path), bytes);
    }
    std::filesystem::remove(receipt_path(plan, step));
    EXPECT_FALSE(do_step(plan, step).done_before) << "a file without a receipt";
    EXPECT_EQ(read_bytes(path), bytes);
  }
}

TEST_F(Steps, ReportThatAnotherProcessRunsThem) {
  prepare(bumpy_sphere(40), 8);
  const Plan plan = plan_of(config("plan", 2));
  for (const PlanStep& step : plan.steps) {
    {
      const ScratchDir others(plan.path(step.output) + ".scratch");
      EXPECT_TRUE(runs_elsewhere(plan, step, {}));
      EXPECT_SVDAG_ERROR(do_step(plan, step), kRunsElsewhere,
                         "another process is running " + step.name);
    }
    EXPECT_FALSE(runs_elsewhere(plan, step, {}));
    do_step(plan, step);
  }
  EXPECT_EQ(read_bytes(plan.path("scene.svdag")), expected_);
}

// Leaves the scratch of a killed bake of an empty scene.
void leave_unfinished(const std::string& folder, const std::string& description, const Grid& grid) {
  Workspace workspace(folder, 0, 1);
  Checkpoint checkpoint(&workspace);
  checkpoint.begin(description, grid);
  checkpoint.save_split({});
}

TEST_F(Steps, DiscardScratchOfAnotherPlan) {
  prepare(bumpy_sphere(40), 8);
  const Plan plan = plan_of(config("plan", 2));
  for (const PlanStep& step : plan.steps) {
    const std::string scratch = plan.path(step.output) + ".scratch";
    leave_unfinished(scratch, "resolution: 16\n", plan.grid);
    do_step(plan, step);
    EXPECT_FALSE(std::filesystem::exists(scratch));
  }
  EXPECT_EQ(read_bytes(plan.path("scene.svdag")), expected_);
}

std::string description_of(const Plan& plan, const PlanStep& shard) {
  const ReadySplit ready{plan.description, plan.grid, {}, {}, nullptr, {}};
  BuildConfig own;
  own.ready = &ready;
  own.part = shard.cells;
  return describe(own, {});
}

// Leaves the scratch of a killed shard that had saved its first brick.
void leave_a_brick(const Plan& plan, const PlanStep& shard) {
  Workspace workspace(plan.path(shard.output) + ".scratch", 0, 1);
  Scratch& scratch = *workspace.scratch();
  Checkpoint checkpoint(&workspace);
  checkpoint.begin(description_of(plan, shard), plan.grid);
  const auto spill = [&](const std::string& bytes) {
    SpillWriter writer(scratch.runs(), scratch.new_streams(), workspace.budget());
    writer.append(std::as_bytes(std::span(bytes)));
    return writer.finish();
  };
  const int bricks = plan.grid.levels - 2;
  const uint64_t morton = shard.cells.begin << 3 * (bricks - shard.cells.level);
  BakedRun baked;
  baked.run.bricks.spilled = spill("8 bytes.");
  baked.run.nodes.resize(size_t(bricks));
  for (auto& level : baked.run.nodes) level.spilled = spill("");
  baked.roots = {{morton, bricks, 0, 0}};
  baked.finished = {{morton << 6, (morton + 1) << 6}};
  checkpoint.save_run(baked);
}

// A journal of one record, four zeros.
void write_journal(const std::string& scratch, SavedKind kind) {
  ScratchDir folder(scratch);
  folder.keep();
  std::vector<JournalRecord> none;
  Journal journal(folder.create("journal"), &none);
  journal.append(uint32_t(kind), std::vector<std::byte>(4));
}

// svdag run and farms start steps without --restart.
TEST_F(Steps, StartOverIfTheirScratchIsDamaged) {
  prepare(bumpy_sphere(40), 8);
  const Plan plan = plan_of(config("plan", 2));
  const PlanStep& shard = plan.steps[0];
  const std::string output = plan.path(shard.output), scratch = output + ".scratch";
  do_step(plan, shard);
  const std::string bytes = read_bytes(output);
  const std::map<std::string, std::function<void()>> damages = {
      {"a block of a run",
       [&] {
         std::string runs = read_bytes(scratch + "/runs");
         runs[64] ^= 1;
         write(scratch + "/runs", runs);
       }},
      {"runs cut short", [&] { std::filesystem::resize_file(scratch + "/runs", 4096); }},
      {"no runs", [&] { std::filesystem::remove(scratch + "/runs"); }},
      {"a journal of nonsense", [&] { write_journal(scratch, SavedKind::kRun); }},
      {"a journal of another version", [&] { write_journal(scratch, SavedKind::kBake); }}};
  for (const auto& [what, damage] : damages) {
    std::filesystem::remove(output);
    leave_a_brick(plan, shard);
    damage();
    do_step(plan, shard);
    EXPECT_EQ(read_bytes(output), bytes) << what;
    EXPECT_FALSE(std::filesystem::exists(scratch)) << what;
  }
  std::filesystem::remove(output);
  leave_a_brick(plan, shard);
  do_step(plan, shard);
  EXPECT_NE(read_bytes(output), bytes) << "undamaged scratch is resumed";
}

TEST_F(Steps, StartOverWithRestart) {
  prepare(bumpy_sphere(40), 8);
  const Plan plan = plan_of(config("plan", 2));
  const PlanStep& shard = plan.steps[0];
  do_step(plan, shard);
  const std::string bytes = read_bytes(plan.path(shard.output));
  for (const bool restart : {false, true}) {
    std::filesystem::remove(plan.path(shard.output));
    leave_unfinished(plan.path(shard.output) + ".scratch", description_of(plan, shard), plan.grid);
    StepConfig config;
    config.restart = restart;
    do_step(plan, shard, config);
    EXPECT_EQ(read_bytes(plan.path(shard.output)) == bytes, restart)
        << "without restart, saved work is resumed";
  }
}

TEST_F(Steps, ThatMergeRejectMissingAndForeignRuns) {
  prepare(bumpy_sphere(40), 8);
  const Plan plan = plan_of(config("plan", 2));
  const PlanStep& merge = plan.steps.back();
  EXPECT_SVDAG_ERROR(do_step(plan, merge), ExitCode::kBadInput,
                     "run step shard-1 of the plan first");
  do_step(plan, plan.steps[0]);
  EXPECT_SVDAG_ERROR(do_step(plan, merge), ExitCode::kBadInput,
                     "run step shard-2 of the plan first");
  do_step(plan, plan.steps[1]);

  // The same grid and the same parts, but another scene.
  std::vector<Triangle> dented = bumpy_sphere(40);
  for (int a = 0; a < 3; ++a) dented[dented.size() / 3].v[0][a] *= 0.9;
  write_stl(scene_, dented);
  const Plan other = plan_of(config("other", 2));
  ASSERT_EQ(other.grid, plan.grid);
  for (size_t i = 0; i < 2; ++i) {
    do_step(other, other.steps[i]);
    const std::string path = plan.path(plan.steps[i].output), own = read_bytes(path);
    write(path, read_bytes(other.path(other.steps[i].output)));
    if (read_bytes(path) == own) continue;  // this half was not dented
    EXPECT_SVDAG_ERROR(do_step(plan, merge), ExitCode::kBadInput, "not the output of step shard-");
    std::filesystem::copy_file(receipt_path(other, other.steps[i]),
                               receipt_path(plan, plan.steps[i]),
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_SVDAG_ERROR(do_step(plan, merge), ExitCode::kBadInput, "not the output of step shard-");
    do_step(plan, plan.steps[i]);
  }
  do_step(plan, merge);
  EXPECT_EQ(read_bytes(plan.path("scene.svdag")), expected_);
}

TEST_F(Steps, OfAnOlderPlanAreNotValid) {
  prepare(bumpy_sphere(40), 8);
  const PlanConfig c = config("plan", 2);
  do_steps(plan_of(c));
  std::filesystem::remove(folder_.file("plan/plan.json"));
  PlanConfig again = c;
  again.shards = 3;
  const Plan plan = plan_of(again);
  for (const PlanStep& step : plan.steps)
    EXPECT_NE(output_state(plan, step, plan.path(step.output), false), OutputState::kValid);
  do_steps(plan);
  EXPECT_EQ(read_bytes(plan.path("scene.svdag")), expected_);
}

TEST_F(Steps, ReportADamagedPlanAsBadInput) {
  prepare(random_soup(20'000, 0.05, 1), 9);
  const Plan plan = plan_of(config("plan", 4));
  std::string triangles = read_bytes(plan.path(kPlanTriangles));
  for (size_t at = 500; at < triangles.size(); at += 4096) triangles[at] ^= 1;
  write(plan.path(kPlanTriangles), triangles);
  EXPECT_SVDAG_ERROR(do_step(plan, plan.steps[1]), ExitCode::kBadInput, "triangles");
  std::filesystem::remove(plan.path(kPlanTriangles));
  EXPECT_SVDAG_ERROR(do_step(plan, plan.steps[1]), ExitCode::kBadInput, "triangles");
}

// Scratch beside another output may belong to any bake.
TEST_F(Steps, ThatWriteElsewhereDiscardNothing) {
  prepare(bumpy_sphere(40), 8);
  const Plan plan = plan_of(config("plan", 2));
  for (const PlanStep& step : plan.steps) do_step(plan, step);
  for (const PlanStep* step : {&plan.steps.front(), &plan.steps.back()}) {
    StepConfig elsewhere;
    elsewhere.output = folder_.file(step->is_shard() ? "mine.run" : "mine.svdag");
    const std::string scratch = elsewhere.output + ".scratch";
    leave_unfinished(scratch, "resolution: 16\n", plan.grid);
    EXPECT_SVDAG_ERROR(do_step(plan, *step, elsewhere), ExitCode::kUsage, "mine");
    EXPECT_TRUE(std::filesystem::exists(scratch));
    EXPECT_FALSE(std::filesystem::exists(elsewhere.output));
  }
}

TEST_F(Steps, MayWriteElsewhere) {
  prepare(bumpy_sphere(40), 8);
  const Plan plan = plan_of(config("plan", 2));
  StepConfig elsewhere;
  elsewhere.output = folder_.file("mine.run");
  EXPECT_FALSE(do_step(plan, plan.steps[0], elsewhere).done_before);
  EXPECT_TRUE(do_step(plan, plan.steps[0], elsewhere).done_before);
  EXPECT_FALSE(std::filesystem::exists(plan.path(plan.steps[0].output)));
}

}  // namespace
}  // namespace svdag
