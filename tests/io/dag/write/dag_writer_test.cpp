#include "io/dag/write/dag_writer.h"

#include <gtest/gtest.h>

#include <random>
#include <span>

#include "io/dag/dag_file.h"
#include "io/dag/dag_stats.h"
#include "streaming/error.h"
#include "tests/expect_error.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

Grid small_grid() {
  Grid grid;
  grid.levels = 4;
  grid.voxel_size = 0.1;
  grid.origin = {1, 2, 3};
  grid.selection = grid.whole();
  return grid;
}

// Two voxels: (0, 0, 0) and (15, 15, 15).
void write_two_voxels(const std::string& path) {
  DagWriter writer(path, small_grid(), Rule::kConservative);
  writer.begin_level(2);
  const uint32_t low = writer.add_brick(1), high = writer.add_brick(uint64_t(1) << 63);
  writer.begin_level(1);
  NodeKey first{}, last{};
  last[7] = 1 + high;
  first[0] = 1 + low;
  const uint32_t b = writer.add_node(last), a = writer.add_node(first);
  writer.begin_level(0);
  NodeKey root{};
  root[0] = 1 + a;
  root[7] = 1 + b;
  writer.add_node(root);
  writer.finish(2, 0.125);
}

TEST(DagWriter, WritesAFileThatReadsBack) {
  const TempFolder folder;
  write_two_voxels(folder.file("a.svdag"));
  const DagFile file = DagFile::open(folder.file("a.svdag"));
  EXPECT_EQ(file.grid(), small_grid());
  EXPECT_EQ(file.rule(), Rule::kConservative);
  for (uint32_t x = 0; x < 16; ++x) {
    for (uint32_t y = 0; y < 16; ++y) {
      for (uint32_t z = 0; z < 16; ++z)
        EXPECT_EQ(dag_voxel(file.view(), x, y, z), (x == y && y == z && (x == 0 || x == 15)));
    }
  }
  EXPECT_EQ(file.metadata(),
            "{\"format\":\"svdag\",\"version\":1,\"levels\":4,\"resolution\":16,\"rule\":"
            "\"conservative\","
            "\"fraction_bits\":23,\"grid\":{\"kind\":\"box\",\"corner\":[1,2,3],\"voxel_size\":0.1,"
            "\"k0\":[0,0,0],\"bounded\":false,\"selection\":[0,0,0,16,16,16]},\"voxels\":2,"
            "\"nodes\":[1,2,2],\"largest_snap\":0.125}\n");
}

// A tree of random bricks and nodes, written key by key or in pieces of `size` keys that are
// encoded and stored in another order than they are appended.
std::string write_random(const std::string& path, size_t size) {
  std::mt19937 random(1);
  Grid grid = small_grid();
  grid.levels = 5;
  grid.selection = grid.whole();
  DagWriter writer(path, grid, Rule::kConservative);
  std::vector<uint32_t> below;
  const auto write = [&](const auto& keys, const auto& add) {
    std::vector<uint32_t> indices;
    if (size == 0) {
      for (const auto& key : keys) indices.push_back(add(key));
      return indices;
    }
    std::vector<LevelPiece> pieces((keys.size() + size - 1) / size);
    for (size_t p = pieces.size(); p-- > 0;) {
      const auto part = std::span(keys).subspan(p * size);
      writer.encode(part.first(std::min(size, part.size())), &pieces[p]);
    }
    for (LevelPiece& piece : pieces) {
      const uint32_t first = writer.append(&piece);
      for (const uint32_t index : piece.indices) indices.push_back(first + index);
    }
    for (size_t p = pieces.size(); p-- > 0;) writer.store(&pieces[p]);
    return indices;
  };
  std::vector<Brick> bricks;
  for (Brick brick = 1; brick <= 30'000; ++brick) bricks.push_back(brick << 20 | random() % 999);
  writer.begin_level(3);
  below = write(bricks, [&](Brick brick) { return writer.add_brick(brick); });
  for (int level = 2; level >= 0; --level) {
    std::vector<NodeKey> nodes;
    for (size_t i = 0; i < (level == 0 ? 1 : below.size() / 4); ++i) {
      nodes.push_back({1 + below[i]});
      for (size_t c = 1; c < 8; ++c)
        nodes.back()[c] = random() % 2 == 0 ? 0 : 1 + below[random() % below.size()];
    }
    writer.begin_level(level);
    below = write(nodes, [&](const NodeKey& node) { return writer.add_node(node); });
  }
  writer.finish(1, 0);
  return read_bytes(path);
}

TEST(DagWriter, PiecesGiveTheBytesOfSingleKeys) {
  const TempFolder folder;
  const std::string expected = write_random(folder.file("a.svdag"), 0);
  ASSERT_GT(expected.size(), 5 * kChecksumBlock);
  for (const size_t size : {1, 100, 7000, 100'000})
    EXPECT_EQ(write_random(folder.file("b.svdag"), size), expected) << size;
}

TEST(DagWriter, AFullSectionIsAnErrorOfAPiece) {
  const TempFolder folder;
  DagWriter writer(folder.file("a.svdag"), small_grid(), Rule::kConservative, {}, 4);
  writer.begin_level(2);
  const std::vector<Brick> four = {1, 2, 3, 4}, fifth = {5};
  LevelPiece piece, next;
  writer.encode(four, &piece);
  EXPECT_EQ(writer.append(&piece), 0U);
  writer.encode(fifth, &next);
  EXPECT_SVDAG_ERROR(writer.append(&next), ExitCode::kOutput, "different bricks");
  EXPECT_THROW(writer.encode(four, &next), Error);  // not ascending
}

TEST(DagStats, CountTreeAndDag) {
  const TempFolder folder;
  write_two_voxels(folder.file("a.svdag"));
  const DagStats stats = compute_stats(DagFile::open(folder.file("a.svdag")));
  EXPECT_EQ(stats.voxels, 2U);
  EXPECT_EQ(stats.svo_nodes(), 1U + 2 + 2 + 2);
  EXPECT_EQ(stats.dag_nodes(), 1U + 2 + 2);
  EXPECT_EQ(stats.paper_dag_nodes(), 1U + 2 + 2 + 2);
}

TEST(DagWriter, AFullSectionIsAnError) {
  const TempFolder folder;
  DagWriter writer(folder.file("a.svdag"), small_grid(), Rule::kConservative, {}, 4);
  writer.begin_level(2);
  for (Brick brick = 1; brick <= 4; ++brick) writer.add_brick(brick);
  EXPECT_SVDAG_ERROR(writer.add_brick(5), ExitCode::kOutput, "different bricks");
  writer.begin_level(1);
  writer.add_node({1});
  EXPECT_SVDAG_ERROR(writer.add_node({1, 2}), ExitCode::kOutput, "level 1 needs more than");
  EXPECT_EQ(writer.add_node({2}), 2U);
  EXPECT_SVDAG_ERROR(writer.add_node({3}), ExitCode::kOutput, "level 1 needs more than");
}

TEST(DagWriter, RejectsLevelsAndNodesThatViolateTheFormat) {
  const TempFolder folder;
  DagWriter writer(folder.file("a.svdag"), small_grid(), Rule::kConservative);
  EXPECT_THROW(writer.begin_level(1), Error);
  writer.begin_level(2);
  EXPECT_THROW(writer.add_brick(0), Error);
  EXPECT_THROW(writer.add_node({}), Error);
  EXPECT_THROW(writer.finish(0, 0), Error);
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.svdag")));
}

}  // namespace
}  // namespace svdag
