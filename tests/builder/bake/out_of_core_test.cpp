// Memory decides nothing but time: the same bytes within any budget, resumed or not; and what was
// damaged meanwhile is found.
#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "builder/bake/description.h"
#include "builder/build.h"
#include "builder/octree/morton_set.h"
#include "builder/split/triangle_bins.h"
#include "streaming/process/interrupt.h"
#include "tests/builder/bakes.h"
#include "tests/expect_error.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

class OutOfCore : public ::testing::Test {
 protected:
  // Bakes in memory what the others must equal.
  BuildConfig prepare(const std::vector<Triangle>& triangles, int levels,
                      Rule rule = Rule::kConservative) {
    write_stl(folder_.file("scene.stl"), triangles);
    BuildConfig config = config_for(folder_.file("scene.stl"), folder_.file("out.svdag"), levels);
    config.rule = rule;
    bake(config);
    expected_ = read_bytes(config.output);
    std::filesystem::remove(config.output);
    return config;
  }
  bool as_expected(const BuildConfig& config) const {
    return read_bytes(config.output) == expected_ &&
           !std::filesystem::exists(config.output + ".scratch");
  }

  // Stops and resumes a bake until both happened often.
  void stop_anywhere(BuildConfig config, uint64_t least_memory);

  TempFolder folder_;
  std::string expected_;
};

TEST_F(OutOfCore, EveryBudgetAndNumberOfThreadsGivesTheSameBytes) {
  for (const auto& [triangles, levels] :
       {std::pair(random_soup(20'000, 0.1, 1), 8), std::pair(bumpy_sphere(60), 9),
        std::pair(boxes_and_quad(500, 2), 9)}) {
    BuildConfig config = prepare(triangles, levels);
    uint64_t spilled = 0;
    bool emptied = false;  // a table within its bake: more runs than threads
    for (const uint64_t memory : {4 * kMiB, 9 * kMiB, 40 * kMiB, 400 * kMiB}) {
      for (const size_t threads : {1, 2, 8}) {
        if (threads * kMiB > memory) continue;
        config.memory = memory;
        const BuildReport report = bake(config, threads);
        EXPECT_TRUE(as_expected(config)) << memory << " bytes, " << threads << " threads";
        EXPECT_LE(report.peak_counted, memory);
        emptied = emptied || report.runs > threads;
        spilled += report.scratch.written;
      }
    }
    EXPECT_TRUE(emptied);
    EXPECT_GT(spilled, 0U);
  }
}

TEST_F(OutOfCore, TablesAreEmptiedWithinCellsOfEverySize) {
  BuildConfig config = prepare(random_soup(4000, 0.3, 3), 9);
  config.memory = 4 * kMiB;
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    config.rule = rule;
    config.cell_level = -1;
    config.memory = 0;
    bake(config);
    expected_ = read_bytes(config.output);
    config.memory = 4 * kMiB;
    for (const int cell_level : {0, 1, 3, 5}) {
      config.cell_level = cell_level;
      EXPECT_GT(bake(config).runs, 3U);
      EXPECT_TRUE(as_expected(config)) << cell_level;
    }
  }
}

TEST_F(OutOfCore, WithinBounds) {
  BuildConfig config = prepare(random_soup(20'000, 0.1, 5), 8);
  config.bounds = Box{{0.2, 0.1, 0.3}, {0.7, 0.9, 0.6}};
  bake(config);
  expected_ = read_bytes(config.output);
  config.memory = 4 * kMiB;
  bake(config);
  EXPECT_TRUE(as_expected(config));
}

TEST_F(OutOfCore, ManyTrianglesInOneVoxelBakeInLittleMemory) {
  std::vector<Triangle> mesh = random_soup(60'000, 1e-7, 7);
  for (Triangle& t : mesh) {
    for (Point& p : t.v) p = Point(0.437) + 1e-4 * p;
  }
  mesh.push_back({{Point(0), Point(0.01, 0, 0), Point(0, 0.01, 0)}});
  mesh.push_back({{Point(1), Point(0.99, 1, 1), Point(1, 0.99, 1)}});
  BuildConfig config = prepare(mesh, 12);
  config.memory = 4 * kMiB;
  EXPECT_LE(bake(config).peak_counted, config.memory);
  EXPECT_TRUE(as_expected(config));
}

// A killed bake loses no more than --checkpoint says, also where nodes are few.
TEST_F(OutOfCore, ATableThatIsFarFromFullIsSavedInTime) {
  BuildConfig config = prepare(random_soup(20'000, 0.1, 13), 6);
  config.checkpoint = 0.1;
  EXPECT_EQ(bake(config).runs, 1U);
  ParallelExecutor slow(1, [](size_t index) {
    if (index == 3) std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  });
  EXPECT_GT(bake(config, &slow).runs, 1U);
  EXPECT_TRUE(as_expected(config));
}

// Stops what runs meanwhile, after a time.
class StopAfter {
 public:
  explicit StopAfter(std::chrono::milliseconds time)
      : thread_([this, time] {
          std::unique_lock lock(mutex_);
          if (!ended_.wait_for(lock, time, [this] { return done_; })) pretend_interrupt(2);
        }) {}
  ~StopAfter() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    ended_.notify_one();
    thread_.join();
    pretend_interrupt(0);
  }

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool done_ = false;
  std::thread thread_;
};

void OutOfCore::stop_anywhere(BuildConfig config, uint64_t least_memory) {
  using Milliseconds = std::chrono::milliseconds;
  std::mt19937 random(11);
  int stopped = 0, resumed = 0;
  Milliseconds whole(200);  // about what a bake takes on this machine today
  config.unfinished = Unfinished::kResume;
  for (int bakes = 0; bakes < 400 && (stopped < 12 || resumed < 6); ++bakes) {
    config.memory = least_memory + random() % 6 * kMiB;
    config.checkpoint = random() % 2 ? 0.01 : 30;
    const auto start = std::chrono::steady_clock::now();
    try {
      const StopAfter stop(Milliseconds(random() % uint64_t(whole.count()) + 1));
      resumed += bake(config, 1 + random() % 3).resumed;
    } catch (const Interrupted&) {
      ++stopped;
      whole += whole / 8;
      continue;
    }
    whole = std::chrono::duration_cast<Milliseconds>(std::chrono::steady_clock::now() - start) +
            Milliseconds(5);
    ASSERT_TRUE(as_expected(config)) << bakes;
  }
  EXPECT_GE(stopped, 12);
  EXPECT_GE(resumed, 6);
}

TEST_F(OutOfCore, ABakeThatIsStoppedAnywhereIsResumedToTheSameBytes) {
  stop_anywhere(prepare(random_soup(20'000, 0.1, 9), 8), 4 * kMiB);
}

TEST_F(OutOfCore, ASolidThatIsStoppedAnywhereIsResumedToTheSameBytes) {
  std::vector<Triangle> mesh = bumpy_sphere(100);
  for (const Triangle& t : random_soup(5000, 0.2, 9)) {  // a tetrahedron on each
    mesh.push_back(t);
    for (size_t i = 0; i < 3; ++i) mesh.push_back({{t.v[(i + 1) % 3], t.v[i], Point(0.4)}});
  }
  stop_anywhere(prepare(mesh, 8, Rule::kSolid), 8 * kMiB);
}

// Leaves an unfinished bake with runs behind.
void leave_unfinished(BuildConfig config) {
  config.memory = 4 * kMiB;
  config.checkpoint = 0.001;
  config.unfinished = Unfinished::kRestart;
  for (int attempt = 0, milliseconds = 100; attempt < 100; ++attempt) {
    try {
      const StopAfter stop{std::chrono::milliseconds(milliseconds)};
      bake(config);
      milliseconds = milliseconds / 2 + 1;
    } catch (const Interrupted& interrupted) {
      const std::string runs = config.output + ".scratch/runs";
      if (interrupted.resumable && std::filesystem::exists(runs) &&
          std::filesystem::file_size(runs) > 100'000) {
        std::filesystem::remove(config.output);
        return;
      }
      milliseconds += milliseconds / 3 + 1;
    }
  }
  FAIL() << "no bake was stopped in time";
}

TEST_F(OutOfCore, AnUnfinishedBakeIsNeitherLostNorMistakenForAnother) {
  BuildConfig config = prepare(random_soup(20'000, 0.1, 13), 8);
  config.memory = 4 * kMiB;
  leave_unfinished(config);
  EXPECT_SVDAG_ERROR(bake(config), ExitCode::kUsage, "--resume");
  config.unfinished = Unfinished::kResume;
  BuildConfig other = config;
  other.levels = 9;
  EXPECT_SVDAG_ERROR(bake(other), ExitCode::kUsage, "resolution: 256");
  other = config;
  other.rule = Rule::kThin;
  EXPECT_SVDAG_ERROR(bake(other), ExitCode::kUsage, "rule: thin");
  write_stl(folder_.file("scene.stl"), random_soup(20'000, 0.1, 14));
  EXPECT_SVDAG_ERROR(bake(config), ExitCode::kUsage, "content of scene.stl");
  write_stl(folder_.file("scene.stl"), random_soup(20'000, 0.1, 13));
  config.memory = 400 * kMiB;
  EXPECT_TRUE(bake(config, 2).resumed);
  EXPECT_TRUE(as_expected(config));

  leave_unfinished(config);
  config.unfinished = Unfinished::kRestart;
  EXPECT_FALSE(bake(config).resumed);
  EXPECT_TRUE(as_expected(config));
}

TEST_F(OutOfCore, WhatWasDamagedBeforeAResumeIsFound) {
  BuildConfig config = prepare(random_soup(20'000, 0.1, 15), 8);
  config.memory = 4 * kMiB;
  config.unfinished = Unfinished::kResume;
  std::mt19937 random(17);
  int found = 0;
  for (const char* name : {"runs", "triangles", "runs", "triangles", "runs", "triangles"}) {
    leave_unfinished(config);
    const std::string path = config.output + ".scratch/" + name;
    std::string bytes = read_bytes(path);
    ASSERT_GT(bytes.size(), 0U) << name;
    for (int flips = 0; flips < 8; ++flips)
      bytes[random() % bytes.size()] ^= char(1 << random() % 8);
    std::ofstream(path, std::ios::binary) << bytes;
    try {
      bake(config);
      EXPECT_TRUE(as_expected(config));  // all bits were in blocks that are no longer used
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kOutput) << error.what();
      EXPECT_FALSE(std::filesystem::exists(config.output));
      ++found;
    }
  }
  EXPECT_GE(found, 3);
}

TEST(TriangleBins, GiveBackWhatTheyGotAndNothingStandsBesideTheirCubes) {
  const TempFolder directory;
  MemoryBudget budget;
  ScratchDir folder(directory.file("scratch"));
  Scratch scratch(&folder, &budget);
  Grid grid;
  grid.levels = 10;
  grid.selection = grid.whole();
  std::mt19937_64 random(1);
  const auto coordinate = [&](int64_t around, int64_t spread) {
    return around + int64_t(random() % uint64_t(2 * spread)) - spread;
  };
  const int64_t side = int64_t(1) << (grid.levels + grid.fraction());
  for (int depth = 1; depth <= TriangleBins::kMaxDepth; ++depth) {
    TriangleBins bins(grid, Cube(), depth, scratch.triangles(), &scratch);
    std::vector<LatticeTriangle> all;
    for (int i = 0; i < 2000; ++i) {
      LatticeTriangle& t = all.emplace_back();
      const int64_t spread = side >> (random() % 12);
      const LatticePoint centre(coordinate(side / 2, side / 2), coordinate(side / 2, side / 2),
                                coordinate(side / 2, side / 2));
      for (LatticePoint& p : t.v) {
        for (int a = 0; a < 3; ++a)
          p[a] = std::clamp<int64_t>(coordinate(centre[a], spread), -side, 2 * side);
        // Some lie on the planes between bins.
        if (random() % 3 == 0) p.x = p.x >> (grid.fraction() + 4) << (grid.fraction() + 4);
      }
      bins.add(t);
    }
    std::vector<bool> met(all.size());
    for (const TriangleBin& bin : bins.finish()) {
      BinReader reader(scratch.triangles(), bin, &budget);
      std::vector<LatticeTriangle> read;
      CutRecords cuts;
      while (reader.read(100, &read, &cuts)) {
      }
      EXPECT_EQ(read.size(), bin.triangles);
      const MortonRange own = morton_range(bin.cube, grid.levels);
      EXPECT_TRUE(bin.range.begin <= own.begin && own.end <= bin.range.end);
      size_t at = 0;  // in the order they came
      for (const LatticeTriangle& t : read) {
        while (at < all.size() && !(all[at] == t)) ++at;
        ASSERT_LT(at, all.size());
        met[at] = true;
      }
    }
    // A triangle whose centre is in the grid meets a bin there.
    EXPECT_GT(std::count(met.begin(), met.end(), true), 1500);
  }
}

TEST(MortonSet, KnowsNoneSomeAndAllOfARange) {
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::vector<bool> done(200);
    std::vector<MortonRange> ranges;
    for (auto n = random() % 12; n > 0; --n) {
      const uint64_t begin = random() % 190, end = begin + random() % 10;
      ranges.push_back({begin, end});
      for (uint64_t k = begin; k < end; ++k) done[k] = true;
    }
    std::erase_if(ranges, [](const MortonRange& r) { return r.begin == r.end; });
    const MortonSet set(ranges);
    for (int k = 0; k < 100; ++k) {
      const uint64_t begin = random() % 190, end = begin + 1 + random() % 10;
      const auto count = std::count(done.begin() + long(begin), done.begin() + long(end), true);
      const auto expected = count == 0                       ? MortonSet::Coverage::kNone
                            : uint64_t(count) == end - begin ? MortonSet::Coverage::kAll
                                                             : MortonSet::Coverage::kSome;
      EXPECT_EQ(set.coverage({begin, end}), expected);
    }
  }
}

TEST(Description, TellsTheFirstDifference) {
  EXPECT_EQ(difference("a: 1\nb: 2\n", "a: 1\nb: 2\n"), "");
  EXPECT_EQ(difference("a: 1\nb: 2\n", "a: 1\nb: 3\n"), "\"b: 2\" then, \"b: 3\" now");
  EXPECT_EQ(difference("a: 1\n", "a: 1\nb: 3\n"), "nothing then, \"b: 3\" now");
}

}  // namespace
}  // namespace svdag
