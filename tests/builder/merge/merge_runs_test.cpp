// Parts that are baked separately and merged in any tree equal the bake of the whole, byte for
// byte.
#include "builder/merge/merge_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <random>

#include "tests/builder/bakes.h"
#include "tests/expect_error.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {


struct Case {
  const char* name;
  std::vector<Triangle> triangles;
  std::function<void(BuildConfig*)> grid;
};

std::vector<Case> cases() {
  return {
      {"soup", random_soup(3000, 0.2, 1), [](BuildConfig* c) { c->levels = 7; }},
      {"sphere in bounds", bumpy_sphere(40),
       [](BuildConfig* c) {
         c->levels = 8;
         c->bounds = Box{{-0.4, -0.9, 0.1}, {0.7, 0.3, 0.9}};
       }},
      {"thin boxes", boxes_and_quad(40, 2),
       [](BuildConfig* c) {
         c->levels = 8;
         c->rule = Rule::kThin;
       }},
      {"lattice", bumpy_sphere(30), [](BuildConfig* c) { c->voxel_size = 0.0131; }},
      {"lattice in bounds", random_soup(2000, 0.1, 4),
       [](BuildConfig* c) {
         c->voxel_size = 0.007;
         c->bounds = Box{{0.2, 0.1, 0.3}, {0.7, 0.9, 0.6}};
       }},
  };
}

class MergeRuns : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.file(name); }

  BuildConfig prepare(const Case& c) {
    write_stl(path("scene.stl"), c.triangles);
    BuildConfig config = config_for(path("scene.stl"), path("whole.svdag"), 0);
    c.grid(&config);
    bake(config);
    config.output = path("whole.run");
    bake(config, 2);
    return config;
  }

  // Bakes part `i` of `count`, with other threads and memory for each.
  std::string bake_part(BuildConfig config, uint64_t i, uint64_t count) {
    config.output = path(std::to_string(i) + "of" + std::to_string(count) + ".run");
    config.part = GridPart::share(i, count);
    const size_t threads = 1 + i % 3;
    config.memory = (i % 2 ? 4 : 60) * kMiB;
    config.cell_level = int(i % 5) - 1;
    bake(config, threads);
    return config.output;
  }

  void merge_to(const std::string& output, std::vector<std::string> runs, uint64_t memory = 0,
                size_t threads = 2) {
    ParallelExecutor executor(threads);
    Progress progress;
    const MergeRunsReport report =
        merge_runs({std::move(runs), output, memory, {}}, &executor, &progress);
    EXPECT_FALSE(std::filesystem::exists(output + ".scratch"));
    if (memory != 0) {
      EXPECT_LE(report.peak_counted, memory);
    }
    scratch_written_ += report.scratch_written;
  }

  // Merges random groups until few runs are left.
  std::vector<std::string> merge_some(std::vector<std::string> runs, std::mt19937_64* random) {
    for (int made = 0; runs.size() > 4; ++made) {
      std::shuffle(runs.begin(), runs.end(), *random);
      const size_t n = 2 + (*random)() % (runs.size() - 2);
      const std::vector<std::string> group(runs.end() - ptrdiff_t(n), runs.end());
      runs.resize(runs.size() - n);
      runs.push_back(path("joined" + std::to_string(made) + ".run"));
      merge_to(runs.back(), group, made % 2 ? 0 : 3 * kMiB);
    }
    return runs;
  }

  TempFolder folder_;
  uint64_t scratch_written_ = 0;
};

TEST_F(MergeRuns, AnyTreeOfAnyPartsGivesTheBytesOfTheWholeBake) {
  std::mt19937_64 random(1);
  for (const Case& c : cases()) {
    const BuildConfig config = prepare(c);
    const std::string dag = read_bytes(path("whole.svdag")), run = read_bytes(path("whole.run"));
    ASSERT_GT(run.size(), 4096U);
    for (const uint64_t count : {1, 2, 3, 7, 64}) {
      std::vector<std::string> runs;
      for (uint64_t i = 1; i <= count; ++i) runs.push_back(bake_part(config, i, count));
      runs = merge_some(std::move(runs), &random);
      merge_to(path("merged.svdag"), runs);
      EXPECT_TRUE(read_bytes(path("merged.svdag")) == dag) << c.name << ", " << count << " parts";
      merge_to(path("merged.run"), runs);
      EXPECT_TRUE(read_bytes(path("merged.run")) == run) << c.name << ", " << count << " parts";
    }
  }
}

// Calls a function before the second for_each(): a merge has then checked its runs.
class ActBeforeMerging : public SequentialExecutor {
 public:
  explicit ActBeforeMerging(std::function<void()> act) : act_(std::move(act)) {}
  void for_each(size_t count, const Task& task) override {
    if (++calls_ == 2) act_();
    SequentialExecutor::for_each(count, task);
  }

 private:
  std::function<void()> act_;
  int calls_ = 0;
};

// Overwriting a run, as cp does, keeps valid blocks: all runs of one part of one grid have the same
// labels in their blocks.
TEST_F(MergeRuns, FailsIfARunIsOverwrittenMeanwhile) {
  const auto bake_run = [&](const std::vector<Triangle>& triangles, const std::string& name) {
    write_stl(path("scene.stl"), triangles);
    BuildConfig config = config_for(path("scene.stl"), path(name), 8);
    config.bounds = Box{{0, 0, 0}, {1, 1, 1}};
    bake(config);
    return read_bytes(config.output);
  };
  const std::string other = bake_run(random_soup(3000, 0.2, 2), "other.run");
  for (const bool same : {false, true}) {
    bake_run(random_soup(3000, 0.2, 1), "one.run");
    ActBeforeMerging executor([&] {
      if (!same) std::fstream(path("one.run")) << other;
    });
    Progress progress;
    const auto merge = [&] {
      merge_runs({{path("one.run")}, path("merged.svdag"), 0, {}}, &executor, &progress);
    };
    if (same) {
      merge();
    } else {
      EXPECT_SVDAG_ERROR(merge(), ExitCode::kBadInput, "one.run: was changed while it was read");
    }
    EXPECT_EQ(std::filesystem::exists(path("merged.svdag")), same);
  }
}

TEST_F(MergeRuns, ARunOfAPartDoesNotDependOnHowItWasBaked) {
  BuildConfig config = prepare(cases().front());
  for (const CellRange& cells : {CellRange{2, 3, 41}, CellRange{1, 2, 3}, CellRange{3, 100, 101}}) {
    config.part = cells;
    config.output = path("once.run");
    bake(config);
    const std::string once = read_bytes(config.output);
    config.memory = 4 * kMiB;
    config.checkpoint = 1e-6;  // tables are emptied as often as possible
    for (const int cell_level : {0, 2, 5}) {
      config.cell_level = cell_level;
      config.output = path("again.run");
      bake(config, 3);
      EXPECT_TRUE(read_bytes(config.output) == once);
    }
    // Split it into three at cuts that are not borders of its tops.
    const int finer = cells.level + 1;
    const uint64_t begin = 8 * cells.begin, end = 8 * cells.end;
    const uint64_t cuts[4] = {begin, begin + 3, end - 2, end};
    std::vector<std::string> pieces;
    for (int i = 0; i < 3; ++i) {
      config.part = CellRange{finer, cuts[i], cuts[i + 1]};
      config.output = path("piece" + std::to_string(i) + ".run");
      bake(config);
      pieces.push_back(config.output);
    }
    merge_to(path("joined.run"), {pieces[2], pieces[0], pieces[1]});
    EXPECT_TRUE(read_bytes(path("joined.run")) == once);
  }
}

TEST_F(MergeRuns, ManyTrianglesInADenseCubeThatAPartCuts) {
  std::vector<Triangle> mesh = random_soup(60'000, 1e-3, 7);
  for (Triangle& t : mesh) {
    for (Point& p : t.v) p = Point(0.45) + 0.02 * p;  // about voxel (470, 470, 470)
  }
  mesh.push_back({{Point(0), Point(0.01, 0, 0), Point(0, 0.01, 0)}});
  mesh.push_back({{Point(1), Point(0.99, 1, 1), Point(1, 0.99, 1)}});
  BuildConfig config = prepare({"dense", mesh, [](BuildConfig* c) { c->levels = 10; }});
  const int level = 8;  // bricks
  const uint64_t all = uint64_t(1) << 3 * level, cut = morton(LatticePoint(470 / 4));
  config.memory = 4 * kMiB;
  std::vector<std::string> runs;
  for (const CellRange& cells : {CellRange{level, 0, cut}, CellRange{level, cut, all}}) {
    config.part = cells;
    config.output = path(std::to_string(runs.size()) + ".run");
    EXPECT_GT(bake(config).voxels, 1000U);
    runs.push_back(config.output);
  }
  merge_to(path("merged.run"), runs);
  EXPECT_TRUE(read_bytes(path("merged.run")) == read_bytes(path("whole.run")));
}

TEST_F(MergeRuns, LevelsAndMapsLargerThanMemoryAreStreamed) {
  const BuildConfig config =
      prepare({"large", random_soup(20'000, 0.1, 9), [](BuildConfig* c) { c->levels = 9; }});
  const std::vector<std::string> runs = {bake_part(config, 2, 2), bake_part(config, 1, 2)};
  const uint64_t memory = kMiB;
  for (const std::string& run : runs) EXPECT_GT(std::filesystem::file_size(run), 4 * memory);
  for (const size_t threads : {1, 2}) {
    scratch_written_ = 0;
    merge_to(path("merged.run"), runs, memory, threads);
    EXPECT_GT(scratch_written_, 0U);
    EXPECT_TRUE(read_bytes(path("merged.run")) == read_bytes(path("whole.run")));
    merge_to(path("merged.svdag"), runs, memory, threads);
    EXPECT_TRUE(read_bytes(path("merged.svdag")) == read_bytes(path("whole.svdag")));
  }
  // A single run whose maps do not fit either.
  merge_to(path("same.run"), {path("whole.run")}, memory, 1);
  EXPECT_TRUE(read_bytes(path("same.run")) == read_bytes(path("whole.run")));
}

TEST_F(MergeRuns, AnEmptyPartIsARunWithoutNodes) {
  BuildConfig config = prepare(cases()[1]);
  config.output = path("empty.run");
  config.part = CellRange{2, 5, 5};
  EXPECT_EQ(bake(config).voxels, 0U);
  config.output = path("corner.run");
  config.bounds = Box{{5, 5, 5}, {6, 6, 6}};
  config.part = CellRange{1, 0, 2};
  bake(config);
  EXPECT_EQ(bake(config).voxels, 0U);
  merge_to(path("merged.run"), {path("empty.run"), path("whole.run")});
  EXPECT_TRUE(read_bytes(path("merged.run")) == read_bytes(path("whole.run")));
}

TEST_F(MergeRuns, OnlyTheSelectionMustBeCovered) {
  BuildConfig config = prepare(cases()[1]);
  const Grid grid = bake(config).grid;
  std::vector<std::string> needed_runs;
  size_t left_out = 0;
  for (uint64_t i = 1; i <= 64; ++i) {
    const std::string run = bake_part(config, i, 64);
    MemoryBudget budget;
    const RunFile file = RunFile::open(run, &budget);
    bool needed = false;
    for (const Cube& top : file.part().tops()) {
      const int shift = grid.levels - top.level;
      bool meets = true;
      for (int a = 0; a < 3; ++a)
        meets = meets && (top.coordinate[a] << shift) < grid.selection.max[a] &&
                ((top.coordinate[a] + 1) << shift) > grid.selection.min[a];
      needed = needed || meets;
    }
    needed ? needed_runs.push_back(run) : void(++left_out);
  }
  ASSERT_GT(left_out, 0U);
  merge_to(path("merged.svdag"), needed_runs);
  EXPECT_TRUE(read_bytes(path("merged.svdag")) == read_bytes(path("whole.svdag")));
  needed_runs.pop_back();
  EXPECT_SVDAG_ERROR(merge_to(path("x.svdag"), needed_runs), ExitCode::kUsage,
                     "the runs do not cover the grid");
}

TEST_F(MergeRuns, RejectsRunsThatDoNotBelongTogether) {
  BuildConfig config = prepare(cases()[0]);
  config.part = GridPart::share(1, 2);
  config.output = path("a.run");
  bake(config);
  config.part = GridPart::share(2, 2);
  const auto expect_rejected = [&](const char* sentence,
                                   const std::function<void(BuildConfig*)>& change) {
    BuildConfig other = config;
    other.output = path("b.run");
    change(&other);
    bake(other);
    EXPECT_SVDAG_ERROR(merge_to(path("x.run"), {path("a.run"), path("b.run")}), ExitCode::kUsage,
                       sentence);
    EXPECT_FALSE(std::filesystem::exists(path("x.run")));
  };
  expect_rejected("the resolution differs", [](BuildConfig* c) { c->levels = 8; });
  expect_rejected("the rule differs", [](BuildConfig* c) { c->rule = Rule::kThin; });
  expect_rejected("one was baked with --resolution, the other with --voxel-size",
                  [](BuildConfig* c) {
                    c->levels = 0;
                    c->voxel_size = 0.01;
                  });
  expect_rejected("the bounds differ", [](BuildConfig* c) {
    c->levels = 0;
    c->voxel_size = 0.01;
    c->bounds = Box{{0, 0, 0}, {0.5, 0.5, 0.5}};
    BuildConfig first = *c;
    first.output = std::string(c->output).replace(c->output.size() - 5, 1, "a");
    first.part = GridPart::share(1, 2);
    first.bounds = Box{{0, 0, 0}, {0.5, 0.5, 0.6}};
    bake(first);
  });
  expect_rejected("overlap: both hold voxel (0, 0, 0)", [&](BuildConfig* c) {
    c->part.reset();
    c->output = path("a.run");
    bake(*c);
    c->output = path("b.run");
    c->part = GridPart::share(1, 3);
  });
}

}  // namespace
}  // namespace svdag
