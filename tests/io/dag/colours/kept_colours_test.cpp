// Tests that what is made of a part of a coloured file has the colours that its cubes had.
#include "io/dag/colours/kept_colours.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/colour.h"
#include "io/dag/colours/colours_check.h"
#include "io/dag/colours/dag_colours.h"
#include "io/dag/dag_level.h"
#include "io/dag/graph/select.h"
#include "tests/io/dag/colours/coloured_voxels.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

// By Morton code, the colours of the covered cubes of a level.
using Shown = std::map<uint64_t, uint32_t>;

class KeptColours : public testing::Test {
 protected:
  DagFile painted(const RawDag& raw, const VoxelSet& voxels, int level, uint32_t error,
                  int64_t side, bool compact = false) {
    const std::string bare = folder_.file("bare.svdag"), path = folder_.file("painted.svdag");
    RawFile(raw).write(bare);
    const auto cubes = coloured_cubes(voxels, raw.grid.levels, level, mixed_colours(side));
    const std::vector<CubeColour> source = source_of(cubes, level, 9);
    write_coloured(DagFile::open(bare), {uint32_t(level), error}, in_parts(source, 1000), path,
                   room_, &executor_);
    if (!compact) return DagFile::open(path);
    write_selection(DagFile::open(path), {.layout = Layout::kCompact}, bare, room_, &executor_);
    return DagFile::open(bare);
  }

  // The covered cubes of `level` of `voxels`, which are those of `levels`.
  Shown shown(const DagFile& file, const VoxelSet& voxels, int levels, int level) {
    const DagColours colours(file, &budget_);
    Shown result;
    for (const auto& [x, y, z] : voxels) {
      const int shift = levels - level;
      const auto [at, is_new] =
          result.try_emplace(morton_code(x >> shift, y >> shift, z >> shift), 0);
      if (is_new)
        at->second = svdag_colour(colours.view(), uint32_t(level), uint32_t(x >> shift),
                                  uint32_t(y >> shift), uint32_t(z >> shift));
    }
    return result;
  }

  // The voxels of `levels` that a part has: cubes of the original's voxels, in a box.
  static VoxelSet part_of(const VoxelSet& voxels, int shift, const VoxelBox& box) {
    VoxelSet part;
    for (const auto& [x, y, z] : voxels) {
      const LatticePoint at(x >> shift, y >> shift, z >> shift);
      if (holds(box, at)) part.emplace(at.x, at.y, at.z);
    }
    return part;
  }

  // Level K' has the decoded colours of `from`, coarser ones what the header promises.
  void expect_kept(const DagFile& from, const VoxelSet& voxels, const DagFile& file,
                   const VoxelSet& part, bool is_solid_layer = false) {
    ASSERT_TRUE(file.has_colours());
    EXPECT_FALSE(colours_defect(file.bytes().data()));
    const int levels = from.grid().levels, coarse = file.grid().levels;
    const int before = int(from.header().colour_level), kept = int(file.header().colour_level);
    EXPECT_EQ(kept, before <= coarse ? before : coarse - (before - coarse) % 2);
    EXPECT_EQ(file.header().colour_error, from.header().colour_error);
    const Shown old_ones = shown(from, voxels, levels, kept);
    const Shown new_ones = shown(file, part, coarse, kept);
    ColouredCubes decoded;
    for (const auto& [code, colour] : new_ones) {
      const auto old = old_ones.find(code);
      ASSERT_EQ(colour, old == old_ones.end() ? kNoColour : old->second) << code;
      GivenColour& given = decoded[code];
      given.has_colour = colour != kNoColour;
      for (size_t c = 0; c < 3 && given.has_colour; ++c)
        given.linear[c] = uint16_t(std::lround(65535 * light_of(colour >> 8 * c & 255)));
    }
    for (int level = kept - 2; level >= 0; level -= 2) {
      const Shown means = shown(file, part, coarse, level),
                  old = shown(from, voxels, levels, level);
      const auto of_the_rest = expected_colours(decoded, kept, level);
      std::map<uint64_t, size_t> cubes, old_cubes;
      for (const auto& [code, colour] : new_ones) ++cubes[code >> 3 * (kept - level)];
      for (const auto& [code, colour] : old_ones) ++old_cubes[code >> 3 * (kept - level)];
      for (const auto& [code, mean] : means) {
        const bool unchanged = kept == before && cubes[code] == old_cubes[code] && !is_solid_layer;
        ASSERT_EQ(mean, unchanged ? old.at(code) : of_the_rest.at(code)) << level << ' ' << code;
      }
    }
  }

  // A box of voxels as bounds that meet exactly them.
  static Box bounds_of(const Grid& grid, const VoxelBox& box) {
    Box bounds;
    for (int a = 0; a < 3; ++a) {
      bounds.min[a] = grid.corner()[a] + (double(box.min[a]) + 0.25) * grid.voxel_size;
      bounds.max[a] = grid.corner()[a] + (double(box.max[a]) - 0.25) * grid.voxel_size;
    }
    return bounds;
  }

  const TempFolder folder_;
  MemoryBudget budget_;
  const WorkRoom room_{&budget_, folder_.path()};
  ParallelExecutor executor_{2};
};

TEST_F(KeptColours, EveryCubeOfAPartHasTheColourThatItHad) {
  for (uint64_t seed = 0; seed < 120; ++seed) {
    std::mt19937_64 random(seed);
    const auto below = [&](int64_t n) { return int64_t(random() % uint64_t(n)); };
    const int levels = 4 + int(below(3)), level = 1 + int(below(levels));
    VoxelSet voxels = bodies(levels, seed);
    if (below(3) == 0) add_box(&voxels, {LatticePoint(0), LatticePoint(1 << (levels - 1))});
    const DagFile from =
        painted(raw_dag(test_grid(levels), voxels), voxels, level,
                below(2) == 0 ? 0 : 9 * kColourErrorUnit, 1 + below(9), below(3) == 0);
    const int coarse = below(2) == 0 ? levels : 3 + int(below(levels - 2));
    const Grid grid = level_grid(from.grid(), coarse);
    VoxelBox box = grid.whole();
    for (int a = 0; below(4) > 0 && a < 3; ++a) {
      box.min[a] = below(grid.resolution());
      box.max[a] = box.min[a] + 1 + below(grid.resolution() - box.min[a]);
    }
    Selection selection{.level = coarse};
    if (box != grid.whole()) selection.bounds = bounds_of(grid, box);
    const DagFile file = derive(from, selection, room_, &executor_);
    const VoxelSet part = part_of(voxels, levels - coarse, box);
    ASSERT_EQ(file.header().voxels, part.size());
    expect_kept(from, voxels, file, part);
    // The same for any workers, and in the compact layout.
    const DagFile alone = derive(from, selection, room_);
    EXPECT_TRUE(std::ranges::equal(alone.bytes(), file.bytes()));
    selection.layout = Layout::kCompact;
    const Header compact =
        write_selection(from, selection, folder_.file("compact.svdag"), room_, &executor_);
    EXPECT_TRUE(std::ranges::equal(compact.colour_hash, file.header().colour_hash));
    EXPECT_EQ(compact.layout, uint32_t(Layout::kCompact));
    if (HasFatalFailure()) FAIL() << "seed " << seed;
  }
}

TEST_F(KeptColours, APartThatIsTheWholeHasTheSameBytes) {
  const int levels = 6;
  VoxelSet voxels = bodies(levels, 3);
  add_box(&voxels, {LatticePoint(0), LatticePoint(64, 64, 40)});
  for (const int level : {4, 5, 6}) {
    for (const int64_t side : {2, 7, 32}) {
      const DagFile from =
          painted(raw_dag(test_grid(levels), voxels), voxels, level, 9 * kColourErrorUnit, side);
      const DagFile file = derive(from, {.level = levels}, room_);
      EXPECT_TRUE(std::ranges::equal(from.bytes(), file.bytes()));
    }
  }
}

TEST_F(KeptColours, UnchangedChunksAreCopied) {
  const int levels = 7;
  VoxelSet voxels;
  add_box(&voxels, {LatticePoint(0, 0, 60), LatticePoint(128, 128, 64)});
  const DagFile from =
      painted(raw_dag(test_grid(levels), voxels), voxels, levels, 9 * kColourErrorUnit, 13);
  const VoxelBox half{LatticePoint(0), LatticePoint(64, 128, 128)};
  const DagFile file = derive(from, {.bounds = bounds_of(from.grid(), half)}, room_);
  expect_kept(from, voxels, file, part_of(voxels, 0, half));
  const auto chunks_of = [](const DagFile& f) {
    return f.bytes().subspan(f.header().chunks_offset, f.header().chunks_bytes);
  };
  const auto all = chunks_of(from), kept = chunks_of(file);
  ASSERT_LT(kept.size(), all.size());
  EXPECT_TRUE(std::ranges::equal(kept, all.first(kept.size())));
}

TEST_F(KeptColours, LayersHaveTheColoursOfTheUnion) {
  const int levels = 5;
  const std::vector<VoxelSet> sets{bodies(levels, 1), bodies(levels, 2), bodies(levels, 9)};
  VoxelSet all, two = sets[0];
  for (const VoxelSet& set : sets) all.insert(set.begin(), set.end());
  two.insert(sets[2].begin(), sets[2].end());
  const DagFile from =
      painted(raw_layers(test_grid(levels), sets), all, levels, 9 * kColourErrorUnit, 3);
  expect_kept(from, all, derive(from, {.layers = {"b"}}, room_), sets[1]);
  expect_kept(from, all, derive(from, {.layers = {"a", "c"}}, room_), two);
  const DagFile bare = derive(from, {.without_layers = true}, room_);
  expect_kept(from, all, bare, all);
  EXPECT_TRUE(std::ranges::equal(bare.header().colour_hash, from.header().colour_hash));
  EXPECT_FALSE(derive(from, {.layers = {"b"}, .without_colours = true}, room_).has_colours());
}

// A layer of a solid rule may have voxels where the union has none.
TEST_F(KeptColours, VoxelsOutsideOfTheUnionHaveNoColour) {
  const int levels = 4;
  VoxelSet inside, around;
  add_box(&inside, {LatticePoint(2), LatticePoint(9)});
  add_box(&around, {LatticePoint(5), LatticePoint(14)});
  RawDag raw = raw_layers(test_grid(levels), {inside, around}, around);
  raw.rule = Rule::kSolid;
  const DagFile from = painted(raw, around, levels, 0, 2);
  expect_kept(from, around, derive(from, {.layers = {"a"}}, room_), inside, true);
  expect_kept(from, around, derive(from, {.layers = {"b"}}, room_), around, true);
}

}  // namespace
}  // namespace svdag
