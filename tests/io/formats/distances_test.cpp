// Distances are those of a search of all voxels, whatever the window, the limit and the memory.
#include "io/formats/voxels/distances.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "io/formats/voxels/npy_array.h"
#include "tests/temp_folder.h"
#include "tests/voxel_sets.h"

namespace svdag {
namespace {

// The elements of "distance" of an archive.
std::vector<float> read_distances(const std::string& path) {
  const File file = File::open_read(path);
  const ZipEntry entry = read_zip(file).front();
  EXPECT_EQ(entry.name, "distance.npy");
  check_crc(file, entry);
  const NpyArray array = read_npy_header(file, entry.offset, entry.offset + entry.bytes);
  std::vector<float> distances(array.elements());
  file.read_at(array.offset, std::as_writable_bytes(std::span(distances)));
  return distances;
}

float distance_of_all(const std::vector<LatticePoint>& targets, const LatticePoint& from,
                      int limit) {
  int64_t best = int64_t(limit) * limit;
  for (const LatticePoint& to : targets) {
    const LatticePoint d = to - from;
    best = std::min(best, d.x * d.x + d.y * d.y + d.z * d.z);
  }
  return std::sqrt(float(best));
}

void expect_right(int levels, const VoxelSet& set, const VoxelBox& box,
                  const DistanceConfig& config, uint64_t memory) {
  const RawFile file{raw_dag(test_grid(levels), set)};
  CubeWalk walk(file.view(), uint32_t(levels));
  Grid grid = test_grid(levels);
  grid.selection = box;
  const TempFolder folder;
  MemoryBudget budget(memory);
  const std::string path = folder.file("d.npz");
  write_distances({grid, &walk, set.size()}, config, &budget, path);
  const auto distances = read_distances(path);
  // The voxels that are not set, up to N outside of the grid.
  std::vector<LatticePoint> targets, others;
  const int64_t side = grid.resolution(), around = config.is_signed ? config.limit : 0;
  for (int64_t x = -around; x < side + around; ++x)
    for (int64_t y = -around; y < side + around; ++y)
      for (int64_t z = -around; z < side + around; ++z)
        (set.contains({x, y, z}) ? targets : others).push_back({x, y, z});
  size_t i = 0;
  for (int64_t x = box.min.x; x < box.max.x; ++x)
    for (int64_t y = box.min.y; y < box.max.y; ++y)
      for (int64_t z = box.min.z; z < box.max.z; ++z) {
        const LatticePoint at(x, y, z);
        const bool inside = config.is_signed && set.contains({x, y, z});
        const float expected = inside ? -distance_of_all(others, at, config.limit)
                                      : distance_of_all(targets, at, config.limit);
        ASSERT_EQ(distances.at(i++), expected) << x << ' ' << y << ' ' << z;
      }
  EXPECT_EQ(i, distances.size());
}

TEST(Distances, AreThoseOfASearchOfAllVoxels) {
  std::mt19937_64 random(1);
  const auto uniform = [&](int64_t low, int64_t high) {
    return std::uniform_int_distribution<int64_t>(low, high)(random);
  };
  for (int round = 0; round < 40; ++round) {
    const int levels = int(uniform(3, round % 8 == 7 ? 5 : 4));
    const int64_t side = int64_t(1) << levels;
    VoxelSet set;
    if (round % 2 == 0)
      set = bodies(levels, uint64_t(round));
    else
      for (int64_t i = uniform(0, 20); i > 0; --i)
        set.insert({uniform(0, side - 1), uniform(0, side - 1), uniform(0, side - 1)});
    VoxelBox box{LatticePoint(0), LatticePoint(side)};
    if (round % 3 != 0)
      for (int a = 0; a < 3; ++a) {
        box.min[a] = uniform(0, side - 1);
        box.max[a] = uniform(box.min[a] + 1, side);
      }
    const DistanceConfig config{int(round % 5 == 0 ? uniform(7, 12) : uniform(1, 6)),
                                round % 4 < 2};
    expect_right(levels, set, box, config, MemoryBudget::kUnlimited);
  }
}

// A window of several tiles, in planes of 64, and one by one where the memory is short.
TEST(Distances, AreTheSameInAnyMemory) {
  const VoxelSet set = {{0, 0, 0}, {63, 64, 65}, {64, 100, 3}, {127, 127, 127}, {70, 70, 70}};
  const VoxelBox box{{60, 0, 0}, {75, 128, 128}};
  for (const uint64_t memory : {uint64_t(1) << 22, MemoryBudget::kUnlimited})
    expect_right(7, set, box, {.limit = 11}, memory);
}

TEST(Distances, OfTheLargestLimit) {
  const VoxelSet set = {{0, 0, 0}};
  expect_right(7, set, {{36, 36, 0}, {38, 38, 70}}, {.limit = kMaxDistance}, uint64_t(1) << 26);
}

}  // namespace
}  // namespace svdag
