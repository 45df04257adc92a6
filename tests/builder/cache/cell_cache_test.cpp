// The cell cache affects only the time: a bake gives the same bytes with it, without it, and with a
// damaged one.
#include "builder/cache/cell_cache.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <set>
#include <thread>

#include "builder/cache/cell_key.h"
#include "tests/builder/bakes.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

namespace fs = std::filesystem;

Grid grid_of(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.selection = grid.whole();
  return grid;
}

class Cache : public ::testing::Test {
 protected:
  BuildConfig prepare(const std::vector<Triangle>& triangles, int levels,
                      Rule rule = Rule::kConservative) {
    write_stl(folder_.file("scene.stl"), triangles);
    BuildConfig config = config_for(folder_.file("scene.stl"), folder_.file("out.svdag"), levels);
    config.cell_level = 3;
    config.rule = rule;
    config.bounds = Box{Point(0), Point(1)};  // the grid stays where it is
    bake(config);
    expected_ = read_bytes(config.output);
    config.open_store = [this](const Grid& grid, Rule own, MemoryBudget* budget) {
      return std::make_unique<CellCache>(cache_, grid, own, budget);
    };
    return config;
  }
  BuildReport bake_as_expected(const BuildConfig& config, size_t threads = 1) {
    fs::remove(config.output);
    const BuildReport report = bake(config, threads);
    EXPECT_TRUE(read_bytes(config.output) == expected_);
    EXPECT_EQ(report.cache.write_error, "");
    return report;
  }
  std::vector<fs::path> packs() const {
    std::vector<fs::path> packs;
    for (const auto& entry : fs::directory_iterator(cache_.folder)) packs.push_back(entry.path());
    return packs;
  }

  static std::vector<CellKey> keys_of(const fs::path& path) {
    MemoryBudget budget;
    CellPack pack(path);
    pack.read_entries(&budget);
    std::vector<CellKey> keys;
    for (const CellPackEntry& entry : pack.entries()) keys.push_back(entry.key);
    return keys;
  }

  TempFolder folder_;
  CellCacheConfig cache_{folder_.file("cache")};
  std::string expected_;
};

TEST_F(Cache, ASecondBakeTakesEveryCell) {
  const BuildConfig config = prepare(random_soup(3000, 0.1, 1), 8);
  const BuildReport first = bake_as_expected(config);
  EXPECT_EQ(first.cache.hits, 0U);
  const BuildReport second = bake_as_expected(config, 2);
  EXPECT_GT(second.cells, 100U);
  EXPECT_EQ(second.cache.hits, second.cells);
  EXPECT_EQ(second.voxels, first.voxels);
  EXPECT_EQ(second.descent.decisions.total, 0U);
}

TEST_F(Cache, OnlyTheCellsOfATriangleThatMovedAreBaked) {
  std::vector<Triangle> soup = random_soup(2000, 0.05, 2);
  bake_as_expected(prepare(soup, 8));
  for (Point& p : soup[7].v) p += Point(0.01, 0, 0);
  const BuildReport report = bake_as_expected(prepare(soup, 8));
  EXPECT_LT(report.cache.hits, report.cells);
  EXPECT_GT(report.cache.hits, report.cells - 20);
}

// The same triangles in a cell bound another solid if the surface is turned, or is in another one.
TEST_F(Cache, ACellOfASolidServesTheSameWindingsOnly) {
  std::vector<Triangle> ball = bumpy_sphere(20), turned;
  for (Triangle& t : ball) {
    for (Point& p : t.v) p = Point(0.5) + 0.3 * p;
    turned.push_back({{t.v[1], t.v[0], t.v[2]}});
  }
  const auto in_a_box = [](std::vector<Triangle> mesh) {
    for (const Triangle& t : closed_box(Point(-1), Point(2))) mesh.push_back(t);
    return mesh;
  };
  bake_as_expected(prepare(ball, 8, Rule::kSolid));
  EXPECT_GT(bake_as_expected(prepare(ball, 8, Rule::kSolid)).cache.hits, 0U);
  for (const auto& mesh : {turned, in_a_box(ball), in_a_box(turned)}) {
    EXPECT_EQ(bake_as_expected(prepare(mesh, 8, Rule::kSolid)).cache.hits, 0U);
    EXPECT_GT(bake_as_expected(prepare(mesh, 8, Rule::kSolid)).cache.hits, 0U);
  }
}

TEST_F(Cache, EveryBudgetGivesTheSameBytes) {
  BuildConfig config = prepare(random_soup(20'000, 0.1, 3), 8);
  bool spilled = false;
  for (const uint64_t mib : {9, 400, 12, 400}) {
    config.memory = mib << 20;
    spilled |= bake_as_expected(config, 2).scratch.written > 0;
  }
  EXPECT_TRUE(spilled);
}

TEST_F(Cache, APartOfACellIsNotStored) {
  BuildConfig config = prepare(random_soup(500, 0.2, 4), 7);
  config.part = CellRange{5, 0, 20'000};  // ends in the middle of a cell of level 3
  config.output = folder_.file("part.run");
  bake(config);
  config.part.reset();
  config.output = folder_.file("out.svdag");
  bake_as_expected(config);
}

TEST_F(Cache, CellsOfDamagedPacksAreBakedAgain) {
  const BuildConfig config = prepare(random_soup(300, 0.1, 5), 6);
  bake_as_expected(config);
  std::string whole = read_bytes(packs().at(0));
  std::mt19937 random(6);
  for (int run = 0; run < 60; ++run) {
    for (const fs::path& pack : packs()) fs::remove(pack);
    std::string broken = whole;
    const size_t at = random() % broken.size();
    if (run % 3 == 0) {
      broken.resize(at);
    } else {
      broken[at] = char(broken[at] ^ 1 << random() % 8);
    }
    std::ofstream(fs::path(cache_.folder) / "0123456789abcdef.cells", std::ios::binary) << broken;
    const BuildReport report = bake_as_expected(config);
    EXPECT_EQ(report.cache.hits, 0U) << "byte " << at;
    EXPECT_FALSE(fs::exists(fs::path(cache_.folder) / "0123456789abcdef.cells")) << "byte " << at;
  }
}

// The folder may hold other files, some with the extension of packs.
TEST_F(Cache, LeavesOtherFilesAlone) {
  const BuildConfig config = prepare(random_soup(300, 0.1, 5), 6);
  fs::create_directories(cache_.folder);
  for (const char* name : {"report.cells", "0123456789abcdeg.cells", ".cells", "0123456789abcdef"})
    std::ofstream(fs::path(cache_.folder) / name) << name;
  cache_.max_packs = 1;
  cache_.max_bytes = 1;
  bake_as_expected(config);
  for (const char* name : {"report.cells", "0123456789abcdeg.cells", ".cells", "0123456789abcdef"})
    EXPECT_TRUE(fs::exists(fs::path(cache_.folder) / name)) << name;
}

// While this object exists, the process cannot open files.
class NoDescriptorLeft {
 public:
  NoDescriptorLeft() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    struct rlimit few = before_;
    few.rlim_cur = 64;
    ::setrlimit(RLIMIT_NOFILE, &few);
    for (int fd = ::dup(0); fd >= 0; fd = ::dup(0)) taken_.push_back(fd);
  }
  ~NoDescriptorLeft() {
    for (const int fd : taken_) ::close(fd);
    ::setrlimit(RLIMIT_NOFILE, &before_);
  }

 private:
  struct rlimit before_;
  std::vector<int> taken_;
};

TEST_F(Cache, APackThatCannotBeOpenedIsKept) {
  bake_as_expected(prepare(random_soup(300, 0.1, 13), 6));
  const std::vector<fs::path> before = packs();
  MemoryBudget budget(uint64_t(1) << 30);
  const CellKey key = keys_of(before.at(0)).at(0);
  {
    CellCache cache(cache_, grid_of(6), Rule::kConservative, &budget);
    const NoDescriptorLeft none;
    EXPECT_FALSE(cache.take(key, {3, {0, 0, 0}}, {}));
  }
  EXPECT_EQ(packs(), before);
  CellCache cache(cache_, grid_of(6), Rule::kConservative, &budget);
  EXPECT_TRUE(cache.take(key, {3, {0, 0, 0}}, {}));
}

TEST_F(Cache, TheNumberOfOpenPacksIsLimited) {
  std::vector<Triangle> all;
  for (int slice = 0; slice < 5; ++slice) {  // each adds a pack
    const std::vector<Triangle> more = random_soup(200, 0.05, unsigned(30 + slice));
    all.insert(all.end(), more.begin(), more.end());
    bake_as_expected(prepare(all, 7));
  }
  // The cells of all packs, in one bake that may open two of them.
  MemoryBudget budget(uint64_t(1) << 30);
  cache_.max_open = 2;
  CellCache cache(cache_, grid_of(7), Rule::kConservative, &budget);
  std::set<fs::path> used;
  for (const fs::path& path : packs()) {
    for (const CellKey& key : keys_of(path)) {
      if (cache.take(key, {3, {0, 0, 0}}, {})) used.insert(path);
    }
  }
  EXPECT_EQ(used.size(), 2U);
  EXPECT_EQ(packs().size(), 5U);
}

// A pack of `count` empty cells that no bake looks up.
void write_unused_pack(const std::string& path, size_t count) {
  static std::mt19937_64 random(14);
  BakedRun baked;
  baked.run.nodes.resize(4);
  for (size_t i = 0; i < count; ++i)
    baked.cells.push_back({{{random(), random(), random(), random()}}, BakedCell::kNoRoot, 0});
  MemoryBudget budget;
  write_cell_pack(path, baked, 6, nullptr, &budget);
}

TEST_F(Cache, ALargeCacheFitsInLittleMemory) {
  BuildConfig config = prepare(random_soup(20'000, 0.1, 3), 8);
  config.memory = uint64_t(9) << 20;
  const BuildReport alone = bake_as_expected(config, 2);
  EXPECT_EQ(alone.cache.skipped_packs, 0U);
  const std::vector<fs::path> own = packs();
  for (int i = 0; i < 30; ++i)  // the entries take more than twice the budget
    write_unused_pack(cache_.folder + "/" + std::to_string(1000000000000000 + i) + ".cells",
                      16'000);
  for (const fs::path& pack : own)
    fs::last_write_time(pack, fs::file_time_type::clock::now() + std::chrono::hours(1));
  const BuildReport newest = bake_as_expected(config, 2);
  EXPECT_GT(newest.cache.hits, newest.cells - 20) << "the most recently used packs are read first";
  EXPECT_GE(newest.cache.skipped_packs, 25U);
  for (const fs::path& pack : own)
    fs::last_write_time(pack, fs::file_time_type::clock::now() - std::chrono::hours(1));
  bake_as_expected(config, 2);
}

TEST_F(Cache, ManyBakesShareAFolder) {
  const BuildConfig config = prepare(random_soup(1000, 0.1, 7), 7);
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      BuildConfig own = config;
      own.output = folder_.file("out" + std::to_string(i) + ".svdag");
      for (int again = 0; again < 3; ++again) {
        bake(own);
        EXPECT_TRUE(read_bytes(own.output) == expected_);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST_F(Cache, TheLeastRecentlyUsedPacksAreRemovedFirst) {
  BuildConfig config = prepare(random_soup(500, 0.1, 8), 6);
  bake_as_expected(config);
  const fs::path first = packs().at(0);
  fs::last_write_time(first, fs::file_time_type::clock::now() - std::chrono::hours(2));
  prepare(random_soup(500, 0.1, 9), 6);
  bake_as_expected(config);
  ASSERT_EQ(packs().size(), 2U);
  cache_.max_bytes = 2 * fs::file_size(first);
  prepare(random_soup(500, 0.1, 10), 6);
  bake_as_expected(config);
  EXPECT_FALSE(fs::exists(first));
  EXPECT_EQ(packs().size(), 2U);
}

TEST_F(Cache, PacksBeyondTheLimitAreRemoved) {
  cache_.max_packs = 3;
  fs::create_directory(cache_.folder);
  std::vector<fs::path> before;
  for (unsigned seed = 20; seed < 26; ++seed) {
    before = packs();
    bake_as_expected(prepare(random_soup(200, 0.1, seed), 6));
    for (const fs::path& pack : packs()) {  // an hour older than those of the next bake
      const auto used = fs::last_write_time(pack);
      fs::last_write_time(pack, used - std::chrono::hours(1));
    }
  }
  EXPECT_EQ(packs().size(), 3U);
  EXPECT_NE(packs(), before) << "the newest stay";
}

TEST_F(Cache, AFolderThatCannotBeWrittenDoesNotFailTheBake) {
  BuildConfig config = prepare(random_soup(500, 0.1, 11), 6);
  const auto open = config.open_store;
  config.open_store = [&](const Grid& grid, Rule rule, MemoryBudget* budget) {
    auto store = open(grid, rule, budget);
    fs::remove_all(cache_.folder);
    return store;
  };
  const BuildReport report = bake(config);
  EXPECT_TRUE(read_bytes(config.output) == expected_);
  EXPECT_NE(report.cache.write_error, "");
}

// The key of a cube of 32^3 voxels with `triangles`.
CellKey key_of(const Grid& grid, Rule rule, const LatticePoint& cube,
               const std::vector<LatticeTriangle>& triangles, int32_t winding = 0) {
  std::vector<TriangleSetup> setups;
  for (const LatticeTriangle& t : triangles) setups.push_back(make_setup(t));
  TriangleList list;
  for (const TriangleSetup& setup : setups) list.push_back({&setup, setup.edges});
  return cell_key(grid, rule, {grid.levels - 5, cube}, list, winding);
}

TEST(CellKey, DependsOnTheContentAndNotOnThePosition) {
  const Grid grid = grid_of(10);
  const LatticeTriangle a{{LatticePoint(1, 2, 3), {400, 500, 600}, {7000, 8, 9}}};
  const LatticeTriangle b{{LatticePoint(5, 5, 5), {900, 5, 77}, {3, 3000, 4}}};
  const CellKey key = key_of(grid, Rule::kConservative, {0, 0, 0}, {a, b});
  EXPECT_EQ(key, key_of(grid, Rule::kConservative, {0, 0, 0}, {b, a, b}));
  LatticeTriangle moved_a = a, moved_b = b;
  for (LatticeTriangle* t : {&moved_a, &moved_b}) {
    for (LatticePoint& p : t->v) p += LatticePoint(3, 1, 2) * (int64_t(32) << grid.fraction());
  }
  EXPECT_EQ(key, key_of(grid, Rule::kConservative, {3, 1, 2}, {moved_a, moved_b}));
  EXPECT_EQ(key, key_of(grid_of(12), Rule::kConservative, {0, 0, 0}, {a, b}));
}

TEST(CellKey, OfSolidsKnowsOrientationRepetitionAndWinding) {
  const Grid grid = grid_of(10);
  const LatticeTriangle a{{LatticePoint(1, 2, 3), {400, 500, 600}, {7000, 8, 9}}};
  const LatticeTriangle same{{a.v[1], a.v[2], a.v[0]}}, turned{{a.v[1], a.v[0], a.v[2]}};
  LatticeTriangle sheet = a;
  sheet.sheet = 1;
  const auto key = [&](const std::vector<LatticeTriangle>& list, int32_t winding) {
    return key_of(grid, Rule::kSolid, {0, 0, 0}, list, winding);
  };
  EXPECT_EQ(key({a}, 1), key({same}, 1));
  EXPECT_NE(key({a}, 1), key({turned}, 1));
  EXPECT_NE(key({a}, 1), key({a, a}, 1));
  EXPECT_NE(key({a}, 1), key({a}, 0));
  EXPECT_NE(key({a}, 1), key({sheet}, 1));
  EXPECT_NE(key({a}, 1), key_of(grid, Rule::kSolidOdd, {0, 0, 0}, {a}, 1));
}

TEST(CellKey, DiffersWhereTheContentMayDiffer) {
  const Grid grid = grid_of(10);
  const LatticeTriangle a{{LatticePoint(1, 2, 3), {400, 500, 600}, {7000, 8, 9}}};
  const CellKey key = key_of(grid, Rule::kConservative, {0, 0, 0}, {a});
  EXPECT_NE(key, key_of(grid, Rule::kThin, {0, 0, 0}, {a}));
  EXPECT_NE(key, key_of(grid_of(18), Rule::kConservative, {0, 0, 0}, {a}));  // another F
  EXPECT_NE(key, key_of(grid, Rule::kConservative, {0, 0, 1}, {a}));
  EXPECT_NE(key, key_of(grid, Rule::kConservative, {0, 0, 0}, {}));
  LatticeTriangle other = a;
  other.v[2].z += 1;
  EXPECT_NE(key, key_of(grid, Rule::kConservative, {0, 0, 0}, {other}));
  Grid bounded = grid;
  bounded.bounded = true;
  bounded.selection.max.y = 31;
  EXPECT_NE(key, key_of(bounded, Rule::kConservative, {0, 0, 0}, {a}));
  bounded.selection.max.y = 32;  // the whole cell
  EXPECT_EQ(key, key_of(bounded, Rule::kConservative, {0, 0, 0}, {a}));
}

TEST_F(Cache, AKeyThatDiffersInOneByteIsNotFound) {
  const BuildConfig config = prepare(random_soup(300, 0.1, 12), 6);
  bake_as_expected(config);
  MemoryBudget budget(uint64_t(1) << 30);
  const CellKey key = keys_of(packs().at(0)).at(0);
  CellCache cache(cache_, grid_of(6), Rule::kConservative, &budget);
  for (size_t byte = 0; byte < sizeof key; ++byte) {
    CellKey other = key;
    reinterpret_cast<unsigned char*>(other.words.data())[byte] ^= 1;
    EXPECT_FALSE(cache.take(other, {3, {0, 0, 0}}, {}));
  }
  EXPECT_TRUE(cache.take(key, {3, {0, 0, 0}}, {}));
}

}  // namespace
}  // namespace svdag
