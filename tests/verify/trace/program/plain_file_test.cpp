// The reader of svdag-trace accepts sound files, and all files that it accepts are safe to trace.
#include "verify/trace/program/plain_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "io/dag/compact/compact_writer.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"
#include "tests/verify/trace/ray_families.h"
#include "verify/trace/kernel/traverse.h"

namespace svdag {
namespace {

class PlainFileTest : public ::testing::Test {
 protected:
  std::string path() const { return folder_.path() + "/a.svdag"; }
  void write(const std::vector<std::byte>& bytes) const {
    std::ofstream(path(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  }
  TempFolder folder_;
};

TEST_F(PlainFileTest, ReadsTheVoxelsThatWereWritten) {
  const VoxelSet voxels = clustered_voxels(6, 3, 5);
  const RawFile raw(raw_dag(test_grid(6), voxels));
  raw.write(path());
  const PlainFile file = read_plain_file(path());
  for (uint32_t x = 0; x < 64; ++x) {
    for (uint32_t y = 0; y < 64; ++y) {
      for (uint32_t z = 0; z < 64; ++z)
        ASSERT_EQ(dag_voxel(file.view, x, y, z), voxels.count({x, y, z}) > 0);
    }
  }
}

TEST_F(PlainFileTest, ShowsOneLayerAlone) {
  const std::vector<VoxelSet> sets{clustered_voxels(6, 3, 5), clustered_voxels(6, 2, 6), {}};
  RawFile(raw_layers(test_grid(6), sets)).write(path());
  const std::string compact = folder_.path() + "/compact.svdag";
  MemoryBudget budget;
  const WorkRoom room{&budget, folder_.path()};
  write_compact(DagFile::open(path()), compact, room);
  for (const std::string& name : {path(), compact}) {
    PlainFile file = read_plain_file(name);
    ASSERT_EQ(file.layers.layers.size(), sets.size());
    for (size_t layer = 0; layer < sets.size(); ++layer) {
      show_layer(&file, layer);
      EXPECT_EQ(file.view.empty(), sets[layer].empty());
      for (uint32_t x = 0; x < 64; ++x) {
        for (uint32_t y = 0; y < 64; ++y) {
          for (uint32_t z = 0; z < 64; ++z) {
            const bool set = sets[layer].count({x, y, z}) > 0;
            ASSERT_EQ(dag_voxel(file.view, x, y, z), set);
            ASSERT_EQ(layer_of_cube(file.view, file.index->view(), 6, x, y, z),
                      set ? layer : kNoLayer);
          }
        }
      }
    }
  }
}

TEST_F(PlainFileTest, RejectsAnImpossibleLayerTable) {
  RawDag raw = raw_layers(test_grid(5), {clustered_voxels(5, 3, 5), clustered_voxels(5, 2, 6)});
  raw.layers[1].root = 7;
  RawFile(raw).write(path());
  EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput, "an impossible layer table");
}

TEST_F(PlainFileTest, ReadsTheEmptyGrid) {
  RawFile(raw_dag(test_grid(4), {})).write(path());
  EXPECT_TRUE(read_plain_file(path()).view.empty());
}

TEST_F(PlainFileTest, AMissingFileIsAnError) {
  EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput, "cannot be opened");
}

// A file of another kind is not reported as damaged, whatever its bytes at our size field.
TEST_F(PlainFileTest, AFileOfAnotherFormatIsReportedAsSuch) {
  for (const size_t size : {8U, 1023U, 1024U, 5000U}) {
    write(std::vector<std::byte>(size, std::byte{'v'}));
    EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput, "its first bytes are not");
  }
  write({});
  EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput,
                     "is not a .svdag (it is too short)");
}

TEST_F(PlainFileTest, ATruncatedFileIsDamaged) {
  const RawFile raw(raw_dag(test_grid(5), clustered_voxels(5, 3, 3)));
  for (const std::ptrdiff_t size : {8, 1023, 1024}) {
    write({raw.bytes().begin(), raw.bytes().begin() + size});
    EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput, "damaged file: ");
  }
}

TEST_F(PlainFileTest, EveryTruncationIsRejected) {
  const RawFile raw(raw_dag(test_grid(5), clustered_voxels(5, 3, 3)));
  for (size_t size = 0; size < raw.bytes().size(); size += 41) {
    write({raw.bytes().begin(), raw.bytes().begin() + std::ptrdiff_t(size)});
    EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput, "");
  }
}

TEST_F(PlainFileTest, RejectsFoldersAndPipes) {
  EXPECT_SVDAG_ERROR(read_plain_file(folder_.path()), ExitCode::kBadInput, "is a folder");
  ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
  EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput, "is not a regular file");
}

// The range of doubles is accepted, as by svdag-verify check, although no scene needs it.
TEST_F(PlainFileTest, AcceptsGridsOfAnySizeAnywhere) {
  for (const double size : {std::numeric_limits<double>::min(), 1e303}) {
    Grid grid = test_grid(4);
    grid.voxel_size = size;
    grid.origin = Point(1.5e308, -1.5e308, 0);
    RawFile(raw_dag(grid, {{1, 2, 3}})).write(path());
    EXPECT_EQ(read_plain_file(path()).header().voxel_size, size);
  }
}

TEST_F(PlainFileTest, RejectsImpossibleVoxelSizesAndCorners) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double denormal = std::numeric_limits<double>::denorm_min();
  for (const double size : {0.0, denormal, -1.0, infinity, std::nan("")}) {
    Grid grid = test_grid(4);
    grid.voxel_size = size;
    RawFile(raw_dag(grid, {})).write(path());
    EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput, "impossible voxel size");
  }
  for (const double corner : {infinity, -infinity, std::nan("")}) {
    Grid grid = test_grid(4);
    grid.origin = Point(0, corner, 0);
    RawFile(raw_dag(grid, {})).write(path());
    EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput, "impossible grid corner");
  }
}

// It would be a node without a voxel, although its parent says that it is occupied.
TEST_F(PlainFileTest, RejectsAnEmptyBrick) {
  RawDag raw = raw_dag(test_grid(5), clustered_voxels(5, 3, 3));
  raw.bricks.back() = 0;
  RawFile(raw).write(path());
  EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput, "damaged file: an empty brick");
}

TEST_F(PlainFileTest, ObeysTheMemoryLimit) {
  const RawFile raw(raw_dag(test_grid(5), clustered_voxels(5, 3, 3)));
  raw.write(path());
  const uint64_t size = raw.bytes().size();
  EXPECT_EQ(read_plain_file(path(), size).bytes(), size);
  EXPECT_SVDAG_ERROR(read_plain_file(path(), size - 1), ExitCode::kMemory, "svdag-verify render");
  // The size in the header is checked first, before memory is allocated.
  std::filesystem::resize_file(path(), uint64_t(1) << 40);
  EXPECT_SVDAG_ERROR(read_plain_file(path()), ExitCode::kBadInput,
                     "differs from the size in its header");
}

// A damaged word is rejected, or leads to other voxels, but never outside the file (the sanitizers
// would report that).
TEST_F(PlainFileTest, AcceptedFilesAreSafeToTrace) {
  const RawFile raw(raw_dag(test_grid(7), clustered_voxels(7, 8, 6)));
  std::mt19937 random(1);
  RayFamilies rays(2, 128);
  int rejected = 0, accepted = 0;
  for (int i = 0; i < 1500; ++i) {
    std::vector<std::byte> bytes = raw.bytes();
    const size_t end = i % 2 ? 640 : size_t(raw.header().metadata_offset);
    const size_t at = random() % (end / 4) * 4;
    const uint32_t value = i % 3 ? uint32_t(random()) : uint32_t(random() % 300);
    std::memcpy(&bytes[at], &value, 4);
    write(bytes);
    try {
      const PlainFile file = read_plain_file(path());
      ++accepted;
      for (int k = 0; k < 20; ++k)
        trace_closest(file.view, rays.ray(k % kRayFamilies, {{64, 64, 64}}));
    } catch (const Error& error) {
      ++rejected;
      ASSERT_EQ(error.code(), ExitCode::kBadInput);
    }
  }
  EXPECT_GT(rejected, 300);
  EXPECT_GT(accepted, 50);
}

}  // namespace
}  // namespace svdag
