// Tests that every way in which a valid file can fail to be the minimal canonical DAG is reported.
#include "verify/integrity/integrity.h"

#include <gtest/gtest.h>

#include <random>

#include "io/dag/dag_file.h"
#include "streaming/error.h"
#include "tests/temp_folder.h"
#include "tests/verify/raw_dag.h"
#include "verify/integrity/union_check.h"

namespace svdag {
namespace {

VoxelSet random_voxels(int levels, int count, uint64_t seed) {
  std::mt19937_64 random(seed);
  VoxelSet voxels;
  const uint64_t mask = (uint64_t(1) << levels) - 1;
  for (int i = 0; i < count; ++i) voxels.emplace(random() & mask, random() & mask, random() & mask);
  return voxels;
}

RawDag good_dag() {
  return raw_dag(test_grid(6), random_voxels(6, 500, 7));
}

IntegrityReport inspect_raw(const RawDag& raw) {
  const RawFile file(raw);
  const Header& h = file.header();
  const auto table = std::span(file.bytes()).subspan(h.layers_offset, h.layers_bytes);
  return inspect(h, file.view(), file.metadata(), decode_layers(h, table).value_or(LayerTable()));
}

// Succeeds if one of the defects contains `words`.
::testing::AssertionResult reports(const IntegrityReport& report, const std::string& words) {
  std::string all;
  for (const std::string& defect : report.defects) {
    if (defect.find(words) != std::string::npos) return ::testing::AssertionSuccess();
    all += defect + "; ";
  }
  return ::testing::AssertionFailure() << "\"" << words << "\" is not in: " << all;
}

TEST(Integrity, MinimalDagIsSoundAndCounted) {
  for (int levels = 3; levels <= 8; ++levels) {
    for (const int count : {1, 20, 3000}) {
      const VoxelSet voxels = random_voxels(levels, count, uint64_t(levels));
      const RawDag raw = raw_dag(test_grid(levels), voxels);
      const IntegrityReport report = inspect_raw(raw);
      EXPECT_TRUE(report.sound()) << levels << ", " << count << ": " << report.defects.front();
      EXPECT_EQ(report.voxels, voxels.size());
      EXPECT_EQ(report.nodes, raw.nodes);
    }
  }
}

TEST(Integrity, EmptyGridIsSound) {
  EXPECT_TRUE(inspect_raw(raw_dag(test_grid(5), {})).sound());
}

// Layers that meet in voxels, in bricks and in cubes only, one that is empty, two that are equal.
std::vector<VoxelSet> layers_of(int levels, uint64_t seed) {
  std::vector<VoxelSet> sets{random_voxels(levels, 300, seed),
                             random_voxels(levels, 300, seed + 1),
                             random_voxels(levels, 3, seed + 2),
                             {}};
  sets.push_back(sets[0]);
  return sets;
}

TEST(Integrity, FilesWithLayersAreSound) {
  for (int levels = 3; levels <= 8; ++levels) {
    const IntegrityReport report = inspect_raw(raw_layers(test_grid(levels), layers_of(levels, 3)));
    EXPECT_TRUE(report.sound()) << levels << ": " << report.defects.front();
  }
}

// The union as it is, beside layers: one lacks a voxel, or has one more.
TEST(Integrity, ReportsAUnionThatIsNotTheVoxelsOfTheLayers) {
  for (int levels = 3; levels <= 8; ++levels) {
    std::vector<VoxelSet> sets = layers_of(levels, 3);
    sets.pop_back();
    ASSERT_TRUE(inspect_raw(raw_layers(test_grid(levels), sets)).sound());
    VoxelSet all = sets[0];
    for (const VoxelSet& set : sets) all.insert(set.begin(), set.end());
    auto only = sets[1].begin();  // will be in no other layer
    while (sets[0].count(*only) + sets[2].count(*only) > 0) ++only;
    for (const bool lacks : {true, false}) {
      std::vector<VoxelSet> wrong = sets;
      if (lacks) wrong[1].erase(*only);
      VoxelSet as_union = all;
      if (!lacks) as_union.erase(*only);
      const RawDag raw_union = raw_layers(test_grid(levels), wrong, as_union);
      EXPECT_TRUE(
          reports(inspect_raw(raw_union), "the union is not exactly the voxels of the layers"));
      RawDag raw = raw_union;
      raw.rule = Rule::kSolid;  // whose union follows from no layer
      EXPECT_TRUE(inspect_raw(raw).sound()) << inspect_raw(raw).defects.front();
    }
  }
}

TEST(Integrity, AUnionOfTooManySubproblemsIsNotProved) {
  const RawFile file(raw_layers(test_grid(8), layers_of(8, 3)));
  const DagView dag = file.view();
  std::vector<uint32_t> roots;
  for (uint64_t index = 0; index < dag.index_end[0]; index = dag_next(dag, 0, index))
    roots.push_back(uint32_t(index));
  const std::vector<uint32_t> layers(roots.begin() + 1, roots.end());
  EXPECT_EQ(is_union_of(dag, roots[0], layers), true);
  EXPECT_EQ(is_union_of(dag, roots[0], layers, 20), std::nullopt);
}

TEST(Integrity, HandMadeFileIsAcceptedByTheReader) {
  const TempFolder folder;
  const std::string path = folder.file("good.svdag");
  RawFile(good_dag()).write(path);
  const DagFile file = DagFile::open(path);
  EXPECT_TRUE(inspect(file.header(), file.view(), file.metadata()).sound());
}

TEST(Integrity, ReportsBricksOutOfOrderOrRepeatedOrEmpty) {
  RawDag raw = good_dag();
  std::swap(raw.bricks[3], raw.bricks[4]);
  EXPECT_TRUE(reports(inspect_raw(raw), "level 4 has 1 bricks that are empty, repeated"));
  raw = good_dag();
  raw.bricks[4] = raw.bricks[3];
  EXPECT_TRUE(reports(inspect_raw(raw), "bricks that are empty, repeated"));
  raw = good_dag();
  raw.bricks[0] = 0;
  EXPECT_TRUE(reports(inspect_raw(raw), "bricks that are empty, repeated"));
}

TEST(Integrity, ReportsNodesOutOfOrder) {
  // Swaps the two nodes of level 1 and the pointers to them: the voxels are the same and every node
  // is used, only the order is wrong.
  RawDag raw = raw_dag(test_grid(4), {{0, 0, 0}, {8, 8, 8}, {12, 12, 13}});
  ASSERT_EQ(raw.nodes[1], 2U);
  std::vector<uint32_t>& words = raw.words[1];
  ASSERT_EQ(words.size(), 5U);  // {mask, a, b} and {mask, c}, or the other way round
  const uint32_t first = 1 + uint32_t(std::popcount(words[0]));
  std::rotate(words.begin(), words.begin() + first, words.end());
  for (size_t i = 1; i < raw.words[0].size(); ++i)
    raw.words[0][i] = raw.words[0][i] == 0 ? 5 - first : 0;
  const IntegrityReport report = inspect_raw(raw);
  EXPECT_TRUE(reports(report, "level 1 has 1 nodes that are repeated or out of order"));
  EXPECT_EQ(report.defects.size(), 1U);
  EXPECT_EQ(report.voxels, 3U);
}

TEST(Integrity, RepeatedNodeIsNotReduced) {
  // Both children of the root are equal, but each is stored separately.
  RawDag raw = raw_dag(test_grid(4), {{0, 0, 0}, {8, 8, 8}});
  ASSERT_EQ(raw.nodes[1], 1U);
  const std::vector<uint32_t> node = raw.words[1];
  raw.words[1].insert(raw.words[1].end(), node.begin(), node.end());
  raw.nodes[1] = 2;
  raw.words[0][2] = uint32_t(node.size());
  const IntegrityReport report = inspect_raw(raw);
  EXPECT_TRUE(reports(report, "level 1 has 1 nodes that are repeated or out of order"));
  EXPECT_EQ(report.defects.size(), 1U);
}

TEST(Integrity, UnusedBrickAndUnusedNodeAreNotMinimal) {
  RawDag raw = good_dag();
  raw.bricks.push_back(~uint64_t(0));
  ++raw.nodes.back();
  EXPECT_TRUE(reports(inspect_raw(raw), "level 4 has 1 nodes that no node uses"));
  raw = good_dag();
  const uint32_t last = uint32_t(raw.bricks.size() - 1);
  for (const uint32_t word : {0x01U, last}) raw.words[3].push_back(word);
  ++raw.nodes[3];
  EXPECT_TRUE(reports(inspect_raw(raw), "level 3 has 1 nodes that no node uses"));
}

TEST(Integrity, ReportsWrongCountsInTheHeader) {
  RawDag raw = good_dag();
  ++raw.voxels;
  EXPECT_TRUE(reports(inspect_raw(raw), "the header counts " + std::to_string(raw.voxels)));
  raw = good_dag();
  ++raw.nodes[2];
  EXPECT_TRUE(reports(inspect_raw(raw), "level 2 has"));
}

TEST(Integrity, ReportsPointersIntoTheMiddleOfANodeOrBeyond) {
  RawDag raw = good_dag();
  raw.words[0][1] += 1;
  EXPECT_TRUE(
      reports(inspect_raw(raw), "level 0 has 1 child pointers to words where no node begins"));
  raw = good_dag();
  raw.words[3][1] = uint32_t(raw.bricks.size());
  EXPECT_TRUE(
      reports(inspect_raw(raw), "level 3 has 1 child pointers to words where no node begins"));
}

TEST(Integrity, ReportsASecondRoot) {
  RawDag raw = good_dag();
  raw.words[0].insert(raw.words[0].end(), {0x80U, 0U});
  ++raw.nodes[0];
  EXPECT_TRUE(reports(inspect_raw(raw), "level 0 has 2 nodes instead of one"));
}

TEST(Integrity, ReportsAVoxelOutsideTheSelection) {
  RawDag raw = good_dag();
  raw.grid.bounded = true;
  EXPECT_TRUE(inspect_raw(raw).sound());
  raw.grid.selection.max.y = 33;
  EXPECT_TRUE(reports(inspect_raw(raw), "outside the selection"));
}

TEST(Integrity, EveryVoxelIsCheckedAgainstTheSelection) {
  std::mt19937_64 random(5);
  int sound = 0;
  for (int round = 0; round < 600; ++round) {
    const int levels = 3 + round % 4;
    VoxelSet voxels;
    const int64_t at = int64_t(random() % 6);
    for (int i = 0; i < 3; ++i)  // close together, so that small selections contain all
      voxels.emplace(at + int64_t(random() % 3), at + int64_t(random() % 3), int64_t(random() % 3));
    RawDag raw = raw_dag(test_grid(levels), voxels);
    raw.grid.bounded = true;
    VoxelBox& selection = raw.grid.selection;
    for (int a = 0; a < 3; ++a) {
      selection.min[a] = a < 2 ? std::max<int64_t>(0, at - 1 + int64_t(random() % 3)) : 0;
      selection.max[a] = std::min(raw.grid.resolution(), at + 1 + int64_t(random() % 4));
      selection.min[a] = std::min(selection.min[a], selection.max[a]);
    }
    bool inside = true;
    for (const auto& [x, y, z] : voxels)
      inside = inside && selection.holds({{x, y, z}, {x + 1, y + 1, z + 1}});
    EXPECT_EQ(inspect_raw(raw).sound(), inside) << round;
    sound += inside;
  }
  EXPECT_GT(sound, 20);
  EXPECT_LT(sound, 580);
}

// A repeating pattern clipped to the selection, first exactly, then with one voxel outside.
TEST(Integrity, SharedNodesAreCutBySelectionsInManyWays) {
  std::mt19937_64 random(9);
  for (int round = 0; round < 60; ++round) {
    VoxelBox box;
    for (int a = 0; a < 3; ++a) {
      box.min[a] = int64_t(random() % 14);
      box.max[a] = 18 + int64_t(random() % 14);
    }
    VoxelSet voxels;
    for (int64_t x = box.min.x; x < box.max.x; ++x)
      for (int64_t y = box.min.y; y < box.max.y; ++y)
        for (int64_t z = box.min.z; z < box.max.z; ++z)
          if ((x * 5 + y * 3 + z) % 8 == round % 8) voxels.emplace(x, y, z);
    const auto sound = [&] {
      RawDag bounded = raw_dag(test_grid(5), voxels);
      bounded.grid.bounded = true;
      bounded.grid.selection = box;
      return inspect_raw(bounded).sound();
    };
    EXPECT_TRUE(sound()) << round;
    LatticePoint beside = box.min + int64_t(2);
    const int a = round % 3;
    beside[a] = round % 2 == 0 ? box.min[a] - 1 : box.max[a];
    if (beside[a] < 0) continue;
    voxels.emplace(beside.x, beside.y, beside.z);
    EXPECT_FALSE(sound()) << round;
  }
}

// 2^40 voxels in the border's plane but 19 nodes: the time must follow the nodes.
TEST(Integrity, AFloorAlongTheBorderOfTheSelectionIsSearchedByNodes) {
  RawDag raw;
  raw.grid = test_grid(20);
  raw.grid.bounded = true;
  raw.words.assign(18, {0x33, 0, 0, 0, 0});  // the children with y = 0
  raw.bricks = {0x0000333300003333};
  raw.nodes.assign(19, 1);
  raw.voxels = uint64_t(1) << 40;
  raw.grid.selection.max.y = 1;
  EXPECT_TRUE(inspect_raw(raw).sound());
  raw.grid.selection.max.x -= 1;
  EXPECT_TRUE(reports(inspect_raw(raw), "outside the selection"));
  raw.grid.selection.max.x += 1;
  raw.grid.selection.min.y = 1;
  raw.grid.selection.max.y = 2;
  EXPECT_TRUE(reports(inspect_raw(raw), "outside the selection"));
}

TEST(Integrity, ReportsALatticePlaneThatIsNotAMultipleOfTheStep) {
  RawDag raw = good_dag();
  raw.grid.kind = Grid::Kind::kLattice;
  raw.grid.k0 = {-1024, 0, 3072};
  EXPECT_TRUE(inspect_raw(raw).sound());
  for (const int64_t k0 : {1, -1, 16, 1025}) {
    raw.grid.k0.y = k0;
    EXPECT_TRUE(reports(inspect_raw(raw), "k0 of the grid's corner is " + std::to_string(k0) +
                                              ", not a multiple of "));
  }
}

TEST(Integrity, ReportsALatticePlaneOfABox) {
  RawDag raw = good_dag();
  raw.grid.k0.z = 1024;
  EXPECT_TRUE(reports(inspect_raw(raw), "the grid is a box, but has a lattice plane k0 = 1024"));
}

TEST(Integrity, ReportsASnapLargerThanHalfALatticeStep) {
  RawDag raw = good_dag();
  raw.largest_snap = 0.25;
  EXPECT_TRUE(reports(inspect_raw(raw), "largest snap"));
}

TEST(Integrity, ReportsMetadataThatDiffersFromTheHeader) {
  const RawDag raw = good_dag();
  const RawFile file(raw);
  const std::string voxels = "\"voxels\":" + std::to_string(raw.voxels);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = file.metadata();
    text.replace(text.find(from), from.size(), to);
    return metadata_defects(file.header(), text);
  };
  EXPECT_TRUE(metadata_defects(file.header(), file.metadata()).empty());
  EXPECT_EQ(with(voxels, voxels + "1").size(), 1U);
  EXPECT_EQ(with("\"box\"", "\"lattice\"").size(), 1U);
  EXPECT_EQ(with("\"rule\":", "\"ruler\":").size(), 2U);  // one key is missing, one unknown
  EXPECT_EQ(with("\"levels\":", "\"levels\":7,\"levels\":"),
            std::vector<std::string>{"the metadata has the key \"levels\" twice"});
  EXPECT_EQ(with("\"corner\":", "\"corner\":0,\"corner\":"),
            std::vector<std::string>{"the metadata has the key \"corner\" twice"});
  const std::string name(1000, 'x');
  EXPECT_EQ(with("\"levels\":", "\"" + name + "\":0,\"levels\":"),
            std::vector<std::string>{"the metadata has an unknown key \"" + name.substr(0, 40) +
                                     "...\""});
  EXPECT_EQ(with("\"corner\":", "\"corner\":0,\"corner\":1,\"corner\":").size(), 1U);
  EXPECT_EQ(metadata_defects(file.header(), "{"),
            std::vector<std::string>{"the metadata is not a JSON object"});
}

// JSON has many texts for one value; the format allows one.
TEST(Integrity, ReportsEqualMetadataInAnotherText) {
  const RawFile file(good_dag());
  const std::string line(file.metadata());
  std::string spaced = line, real = line;
  spaced.insert(1, " ");
  const size_t levels = real.find("\"levels\":") + 9;
  real.insert(real.find(',', levels), ".0");
  for (const std::string& text :
       {line.substr(0, line.size() - 1), line + "\n", line + '\0', line + '\0' + "{\"voxels\":7}",
        "\xEF\xBB\xBF" + line, " " + line, spaced, real}) {
    EXPECT_EQ(metadata_defects(file.header(), text).size(), 1U) << text;
  }
}

TEST(Integrity, ReportsMetadataThatIsNestedTooDeep) {
  const RawFile file(good_dag());
  for (const char* key : {"\"levels\":", "\"corner\":", "\"voxels\":"}) {
    std::string text(file.metadata());
    const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
    text.insert(text.find(key) + std::string(key).size(), deep + ",\"x\":");
    EXPECT_EQ(metadata_defects(file.header(), text),
              std::vector<std::string>{"the metadata is nested too deep"});
  }
  std::string text(file.metadata());
  const size_t at = text.find("\"rule\":") + 7;
  text.replace(at, text.find(',', at) - at, "\"" + std::string(100000, 'x') + "\"");
  const auto defects = metadata_defects(file.header(), text);
  ASSERT_EQ(defects.size(), 1U);
  EXPECT_LT(defects[0].size(), 200U) << "a long value is truncated";
}

}  // namespace
}  // namespace svdag
