// The colours of a tile are, at every covered cube of their level, what a look-up in the file
// gives, in the order in which a walk of the tile meets the cubes.
#include "verify/view/tile_colours.h"

#include <gtest/gtest.h>

#include "tests/io/dag/colours/coloured_voxels.h"
#include "tests/temp_folder.h"
#include "verify/view/tile_file.h"

namespace svdag {
namespace {

class TileColours : public testing::Test {
 protected:
  DagFile painted(int levels, const VoxelSet& voxels, int level) {
    const std::string bare = folder_.file("bare"), path = folder_.file("painted");
    RawFile(raw_dag(test_grid(levels), voxels)).write(bare);
    const std::vector<CubeColour> source =
        source_of(coloured_cubes(voxels, levels, level, mixed_colours(3)), level, 9);
    write_coloured(DagFile::open(bare), {uint32_t(level), 9 * kColourErrorUnit},
                   in_parts(source, 1000), path, {&budget_, folder_.path()}, &executor_);
    return DagFile::open(path);
  }

  // The cubes of `level` with a voxel.
  static std::set<uint64_t> covered(const VoxelSet& voxels, int levels, int level) {
    std::set<uint64_t> cubes;
    for (const auto& [x, y, z] : voxels) {
      const int shift = levels - level;
      cubes.insert(morton_code(x >> shift, y >> shift, z >> shift));
    }
    return cubes;
  }
  static uint32_t looked_up(const DagColours& colours, uint32_t level, uint64_t morton) {
    uint32_t at[3] = {};
    for (uint32_t bit = 0; bit < 3 * level; ++bit)
      at[2 - bit % 3] |= uint32_t(morton >> bit & 1) << bit / 3;
    return svdag_colour(colours.view(), level, at[0], at[1], at[2]);
  }

  const TempFolder folder_;
  MemoryBudget budget_;
  ParallelExecutor executor_{2};
};

TEST_F(TileColours, AreThoseOfTheFileAtEveryCoveredCube) {
  size_t compared = 0;
  for (uint64_t seed = 0; seed < 9; ++seed) {
    const int levels = 4 + int(seed % 3), finest = levels - int(seed / 3 % 3);
    const VoxelSet voxels = bodies(levels, seed);
    const DagFile file = painted(levels, voxels, finest);
    const DagColours colours(file, &budget_);
    for (int level = 0; level <= levels; ++level) {
      std::map<uint64_t, uint32_t> shown;  // in Morton order, which is depth first
      for (const uint64_t cube : covered(voxels, levels, level))
        shown[cube] = looked_up(colours, uint32_t(level), cube);
      for (int outer = 0; outer <= std::min(level, finest); ++outer) {
        auto at = shown.begin();
        for (const uint64_t cube : covered(voxels, levels, outer)) {
          std::vector<uint32_t> expected;
          for (; at != shown.end() && at->first >> 3 * (level - outer) == cube; ++at)
            expected.push_back(at->second);
          const auto found =
              colours_of_tile(colours, uint64_t(1) << 3 * outer | cube, uint32_t(level));
          ASSERT_EQ(found.has_value(), level <= finest && (finest - level) % 2 == 0);
          if (!found) continue;
          ASSERT_EQ(*found, expected) << levels << ' ' << outer << ' ' << level;
          compared += expected.size();
        }
      }
    }
  }
  EXPECT_GT(compared, 10000U);
}

TEST_F(TileColours, OfTooManyCubesDoNotExist) {
  const VoxelSet voxels = bodies(5, 1);
  const DagFile file = painted(5, voxels, 5);
  const DagColours colours(file, &budget_);
  const auto count = uint32_t(voxels.size());
  EXPECT_EQ(colours_of_tile(colours, 1, 5, count)->size(), count);
  EXPECT_FALSE(colours_of_tile(colours, 1, 5, count - 1));
  EXPECT_TRUE(colours_of_tile(colours, 1, 3, count - 1));
}

TEST_F(TileColours, OfPathsThatLeadNowhereDoNotExist) {
  VoxelSet voxels;
  voxels.emplace(1, 2, 3);
  const DagFile file = painted(5, voxels, 5);
  const DagColours colours(file, &budget_);
  EXPECT_EQ(colours_of_tile(colours, 1, 5)->size(), 1U);
  EXPECT_EQ(colours_of_tile(colours, 8, 5)->size(), 1U);
  for (const uint64_t path : {uint64_t(0), uint64_t(2), uint64_t(9), uint64_t(16), ~uint64_t(0),
                              uint64_t(1) << 63, uint64_t(1) << 18})
    EXPECT_FALSE(colours_of_tile(colours, path, 5)) << path;
  EXPECT_FALSE(colours_of_tile(colours, 1, 7));
}

// Tiles of a file with colours are those of the file without.
TEST_F(TileColours, DoNotChangeTheTile) {
  const VoxelSet voxels = bodies(6, 2);
  const DagFile with = painted(6, voxels, 5), without = DagFile::open(folder_.file("bare"));
  EXPECT_EQ(encode_tile(*tile_of_path(TileCutter(with, 6), 1)),
            encode_tile(*tile_of_path(TileCutter(without, 6), 1)));
}

}  // namespace
}  // namespace svdag
