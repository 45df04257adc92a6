// Tiles: their cells are the cubes of the file, in the layers of the file, at every level; they are
// the same for every layout; octants without a tile have nothing finer to show; and nothing but an
// encoded tile is accepted as one.
#include "verify/view/tile.h"

#include <gtest/gtest.h>

#include <random>

#include "builder/build.h"
#include "io/dag/compact/compact_writer.h"
#include "io/dag/layers/layer_index.h"
#include "tests/builder/bakes.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"
#include "tests/voxel_sets.h"
#include "verify/view/folder.h"
#include "verify/view/tile_file.h"

namespace svdag {
namespace {

using Cell = std::array<uint32_t, 3>;
using CellsOfTile = std::map<Cell, std::vector<uint32_t>>;  // cell -> its layers

// The cells of a tile at `corner`, by walking its words as its header describes them.
class TileReader {
 public:
  explicit TileReader(const DagTile& tile) : tile_(tile) {}
  CellsOfTile cells(const Cell& corner) {
    node(0, 0, corner, 1U << (tile_.sections.size() + 1));
    return std::move(cells_);
  }

 private:
  static Cell moved(const Cell& corner, unsigned c, uint32_t side) {
    return {corner[0] + (c >> 2) * side, corner[1] + (c >> 1 & 1) * side,
            corner[2] + (c & 1) * side};
  }
  void node(size_t depth, uint32_t at, const Cell& corner, uint32_t side) {
    const std::vector<uint32_t>& words = tile_.sections[depth];
    if (depth + 1 == tile_.sections.size()) {
      for (unsigned bit = 0; bit < 64; ++bit) {
        if (words[at + bit / 32] >> bit % 32 & 1)
          cell(moved(moved(corner, bit / 8, 2), bit % 8, 1));
      }
      return;
    }
    uint32_t child = at;
    for (unsigned c = 0; c < 8; ++c) {
      if (words[at] >> c & 1) node(depth + 1, words[++child], moved(corner, c, side / 2), side / 2);
    }
  }
  void cell(const Cell& cell) {
    uint32_t value = tile_.layer_root;
    for (size_t shift = tile_.sections.size(); value < kLayerSet; --shift)
      value = tile_.layer_nodes[value + 4 * (cell[0] >> shift & 1) + 2 * (cell[1] >> shift & 1) +
                                (cell[2] >> shift & 1)];
    cells_[cell] =
        value == kNoLayerSet ? std::vector<uint32_t>() : tile_.layer_sets[value - kLayerSet];
  }

  const DagTile& tile_;
  CellsOfTile cells_;
};

class Tiles : public ::testing::Test {
 protected:
  DagFile file_of(int levels, const VoxelSet& voxels) {
    const std::string path = folder_.file("plain.svdag");
    RawFile(raw_dag(test_grid(levels), voxels)).write(path);
    return DagFile::open(path);
  }
  DagFile compact(const DagFile& plain) {
    const std::string path = folder_.file("compact.svdag");
    write_compact(plain, path, room_);
    return DagFile::open(path);
  }
  // Three layers that cross, with or without their union.
  DagFile layered(bool with_union, Layout layout, uint64_t seed) {
    BuildConfig config;
    for (int i = 0; i < 3; ++i) {
      const std::string path = folder_.file("layer" + std::to_string(i) + ".stl");
      write_stl(path, random_soup(40, 1, seed + uint64_t(i)));
      config.scene.paths.push_back(path);
    }
    config.output = folder_.file("layers.svdag");
    config.levels = 7;
    config.layers = LayerKind::kFile;
    config.with_union = with_union;
    config.layout = layout;
    bake(config);
    return DagFile::open(config.output);
  }

  // Whether a cube of level `level` has a voxel, by one descent from the root.
  static bool is_set(const DagView& dag, uint32_t level, const Cell& cell) {
    if (dag.empty()) return false;
    const uint32_t s = dag.levels - level;
    return dag_cube_is_set(dag, 0, 0, level, cell[0] << s, cell[1] << s, cell[2] << s);
  }

  // Whether all cubes of level `level` in one of level `outer` are set, by each layer or none.
  static bool is_full(const DagFile& file, uint32_t level, uint32_t outer, const Cell& cell) {
    const uint32_t side = 1U << (level - outer);
    const size_t layers = file.layers().layers.size();
    for (size_t i = 0; i < std::max<size_t>(1, layers); ++i) {
      const DagView view = layers == 0 ? file.view() : file.view_of(i);
      if (!is_set(view, outer, cell)) continue;
      for (uint32_t n = 0; n < side * side * side; ++n) {
        if (!is_set(view, level,
                    {cell[0] * side + n / side / side, cell[1] * side + n / side % side,
                     cell[2] * side + n % side}))
          return false;
      }
    }
    return true;
  }

  // All tiles, by their paths, against the file.
  void check(const DagFile& file, uint32_t level, uint32_t tile_levels) {
    const TileCutter cutter(file, level, tile_levels);
    std::vector<std::pair<uint64_t, Cell>> open = {{1, {0, 0, 0}}};
    size_t tiles = 0;
    for (size_t i = 0; i < open.size(); ++i) {
      const auto [path, octant] = open[i];
      const auto tile = tile_of_path(cutter, path);
      ASSERT_TRUE(tile);
      ++tiles;
      const uint32_t side = 1U << cutter.tile_levels();
      const Cell corner = {octant[0] * side, octant[1] * side, octant[2] * side};
      const uint32_t k = uint32_t(std::bit_width(path) - 1) / 3;
      const CellsOfTile cells = TileReader(*tile).cells({0, 0, 0});
      check_cells(file, k + cutter.tile_levels(), corner, side, cells);
      const std::string bytes = encode_tile(*tile);
      const auto decoded = decode_tile(std::as_bytes(std::span(bytes)));
      ASSERT_TRUE(decoded);
      EXPECT_EQ(encode_tile(*decoded), bytes);
      for (unsigned c = 0; c < 8; ++c) {
        const Cell at = {2 * octant[0] + (c >> 2), 2 * octant[1] + (c >> 1 & 1),
                         2 * octant[2] + (c & 1)};
        if (tile->finer[c] != 0) {
          EXPECT_EQ(tile->finer[c], path << 3 | c);
          open.emplace_back(tile->finer[c], at);
        } else if (cutter.has_finer({k, {}}) && is_set(file.view(), k + 1, at)) {
          EXPECT_FALSE(tile_of_path(cutter, path << 3 | c));
          EXPECT_TRUE(is_full(file, level, k + 1, at));
        }
      }
    }
    tiles_ += tiles;
  }

  void check_cells(const DagFile& file, uint32_t level, const Cell& corner, uint32_t side,
                   const CellsOfTile& cells) {
    const size_t layers = file.layers().layers.size();
    size_t count = 0;
    Cell at;
    for (at[0] = 0; at[0] < side; ++at[0])
      for (at[1] = 0; at[1] < side; ++at[1])
        for (at[2] = 0; at[2] < side; ++at[2]) {
          const Cell global = {corner[0] + at[0], corner[1] + at[1], corner[2] + at[2]};
          std::vector<uint32_t> members;
          for (uint32_t i = 0; i < layers; ++i) {
            if (is_set(file.view_of(i), level, global)) members.push_back(i);
          }
          const bool set = layers == 0 ? is_set(file.view(), level, global) : !members.empty();
          const auto found = cells.find(at);
          ASSERT_EQ(found != cells.end(), set);
          if (!set) continue;
          ++count;
          ASSERT_EQ(found->second, members);
        }
    EXPECT_EQ(cells.size(), count);
  }

  size_t tiles_ = 0;  // checked
  const TempFolder folder_;
  MemoryBudget budget_;
  WorkRoom room_{&budget_, folder_.path()};
};

TEST_F(Tiles, ShowTheCubesOfTheFileAtEveryLevel) {
  for (uint64_t seed = 0; seed < 4; ++seed) {
    for (const int levels : {3, 4, 6, 7}) {
      const DagFile file = file_of(levels, bodies(levels, seed));
      for (uint32_t level = 3; level <= uint32_t(levels); ++level) {
        check(file, level, 3);
        check(file, level, kTileLevels);
      }
    }
  }
  EXPECT_GT(tiles_, 1000U);
}

TEST_F(Tiles, ShowTheLayersOfEveryCell) {
  for (const bool with_union : {true, false}) {
    for (const Layout layout : {Layout::kPlain, Layout::kCompact}) {
      const DagFile file = layered(with_union, layout, 7);
      for (const uint32_t level : {4, 7}) {
        check(file, level, 3);
        check(file, level, kTileLevels);
      }
    }
  }
}

TEST_F(Tiles, AreTheSameForEveryLayout) {
  const DagFile plain = file_of(7, bodies(7, 1)), other = compact(plain);
  const TileCutter a(plain, 7, 4), b(other, 7, 4);
  const TileList tiles = list_tiles(a), others = list_tiles(b);
  ASSERT_EQ(tiles.cubes.size(), others.cubes.size());
  EXPECT_EQ(tiles.finer, others.finer);
  for (uint64_t id = 1; id <= tiles.cubes.size(); ++id)
    EXPECT_EQ(tile_of_list(a, tiles, id), tile_of_list(b, others, id)) << id;
}

TEST_F(Tiles, OfOctantsThatAreFullDoNotExist) {
  VoxelSet voxels;
  add_box(&voxels, {LatticePoint(0), LatticePoint(64)});
  voxels.emplace(64, 64, 64);
  const DagFile file = file_of(7, voxels);
  const TileCutter cutter(file, 7, 3);
  const auto root = tile_of_path(cutter, 1);
  ASSERT_TRUE(root);
  EXPECT_EQ(root->finer[0], 0U);
  EXPECT_EQ(root->finer[7], 15U);
  // Only the corner's tiles, level by level.
  EXPECT_EQ(list_tiles(cutter).cubes.size(), 5U);
}

TEST_F(Tiles, OfEqualCubesAreOneInAList) {
  VoxelSet voxels;
  add_box(&voxels, {LatticePoint(0, 0, 5), LatticePoint(128, 128, 6)});
  const DagFile file = file_of(7, voxels);
  const TileCutter cutter(file, 7, 3);
  EXPECT_EQ(list_tiles(cutter).cubes.size(), 5U);  // one for each level
}

TEST_F(Tiles, OfPathsThatLeadNowhereDoNotExist) {
  VoxelSet voxels;
  voxels.emplace(1, 2, 3);
  const DagFile file = file_of(7, voxels);
  const TileCutter cutter(file, 7, 3);
  EXPECT_TRUE(tile_of_path(cutter, 1));
  EXPECT_TRUE(tile_of_path(cutter, 8));
  const uint64_t deepest = uint64_t(1) << 12;
  EXPECT_TRUE(tile_of_path(cutter, deepest));
  for (const uint64_t path : {uint64_t(0), uint64_t(2), uint64_t(9), uint64_t(16), deepest << 3,
                              uint64_t(1) << 63, ~uint64_t(0)})
    EXPECT_FALSE(tile_of_path(cutter, path)) << path;
}

TEST_F(Tiles, OfAnEmptyFileDoNotExist) {
  const DagFile file = file_of(5, {});
  const TileCutter cutter(file, 5);
  EXPECT_FALSE(tile_of_path(cutter, 1));
  EXPECT_TRUE(list_tiles(cutter).cubes.empty());
}

TEST_F(Tiles, AreRefusedIfAWordIsMissingOrTooMany) {
  const DagFile file = layered(true, Layout::kPlain, 3);
  const DagTile tile = *tile_of_path(TileCutter(file, 7, 4), 1);
  const auto is_accepted = [](const DagTile& changed) {
    const std::string bytes = encode_tile(changed);
    return decode_tile(std::as_bytes(std::span(bytes))).has_value();
  };
  ASSERT_TRUE(is_accepted(tile));
  std::mt19937_64 random(1);
  for (int i = 0; i < 500; ++i) {
    DagTile changed = tile;
    const size_t part = random() % (tile.sections.size() + 1);
    auto& words = part < tile.sections.size() ? changed.sections[part] : changed.layer_nodes;
    const size_t at = random() % words.size();
    if (i % 2 == 0)
      words.erase(words.begin() + long(at));
    else
      words.insert(words.begin() + long(at), words[random() % words.size()]);
    EXPECT_FALSE(is_accepted(changed)) << part << " " << at;
  }
}

TEST_F(Tiles, AreRefusedIfAReferenceOrSetDoesNotExist) {
  const DagFile file = layered(true, Layout::kPlain, 3);
  const DagTile tile = *tile_of_path(TileCutter(file, 7, 4), 1);
  const auto refuses = [&](const auto& change) {
    DagTile changed = tile;
    change(&changed);
    const std::string bytes = encode_tile(changed);
    return !decode_tile(std::as_bytes(std::span(bytes)));
  };
  EXPECT_TRUE(refuses([](DagTile* t) { t->sections[0][1] = uint32_t(t->sections[1].size()); }));
  EXPECT_TRUE(refuses([](DagTile* t) { t->sections[0][1] += 1; }));
  EXPECT_TRUE(refuses([](DagTile* t) { t->sections[0][0] = 0x100; }));
  EXPECT_TRUE(refuses([](DagTile* t) { t->layer_root = uint32_t(t->layer_nodes.size()); }));
  EXPECT_TRUE(refuses([](DagTile* t) { t->layer_nodes[0] = 0; }));  // would lead to itself
  EXPECT_TRUE(refuses([](DagTile* t) { t->layer_sets.push_back({77}); }));
  EXPECT_TRUE(refuses([](DagTile* t) { t->layer_sets.pop_back(); }));
  EXPECT_TRUE(refuses([](DagTile* t) { t->layer_sets.back() = {2, 1}; }));
}

TEST_F(Tiles, AreRefusedIfTheirBytesAreCutOrChanged) {
  const DagFile file = file_of(6, bodies(6, 3));
  const std::string bytes = encode_tile(*tile_of_path(TileCutter(file, 6), 1));
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_tile(std::as_bytes(std::span(bytes).first(size))));
  for (size_t i = 10; i < bytes.size(); ++i) {  // the first ten are gzip's, partly free
    std::string changed = bytes;
    changed[i] = char(changed[i] ^ 1 << i % 8);
    const auto tile = decode_tile(std::as_bytes(std::span(changed)));
    if (tile) {
      EXPECT_EQ(encode_tile(*tile), bytes) << i;  // a bit that gzip does not use
    }
  }
  const std::string longer = bytes + "x";
  EXPECT_FALSE(decode_tile(std::as_bytes(std::span(longer))));
}

}  // namespace
}  // namespace svdag
