// Tests that what a reader does not check of colours is found: their hash, the cubes of the
// entries, and the geometry's own hash.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "io/dag/colours/dag_colours.h"
#include "io/dag/compact/compact_writer.h"
#include "streaming/error.h"
#include "tests/expect_error.h"
#include "tests/io/dag/colours/coloured_voxels.h"
#include "tests/repair_checksums.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"
#include "verify/integrity/integrity.h"

namespace svdag {
namespace {

constexpr int kTestLevels = 6;

class ColourIntegrity : public ::testing::Test {
 protected:
  ColourIntegrity() {
    VoxelSet voxels = bodies(kTestLevels, 2);
    add_box(&voxels, {LatticePoint(0), LatticePoint(64, 64, 40)});
    RawFile(raw_dag(test_grid(kTestLevels), voxels)).write(folder_.file("plain.svdag"));
    source_ = source_of(coloured_cubes(voxels, kTestLevels, kTestLevels, mixed_colours(32)),
                        kTestLevels, 9);
  }
  std::string painted(const std::string& from) {
    SequentialExecutor executor;
    const std::string path = folder_.file("painted.svdag");
    write_coloured(DagFile::open(from), {uint32_t(kTestLevels), 9 * kColourErrorUnit},
                   in_parts(source_, 500), path, room_, &executor);
    return read_bytes(path);
  }
  std::vector<std::string> defects_of(std::string bytes) {
    repair_checksums(&bytes);
    const std::string path = folder_.file("damaged.svdag");
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    return inspect_file(DagFile::open(path), room_).defects;
  }
  static Header header_of(const std::string& bytes) {
    Header h;
    std::memcpy(&h, bytes.data(), sizeof h);
    return h;
  }

  const TempFolder folder_;
  MemoryBudget budget_;
  const WorkRoom room_{&budget_, folder_.path()};
  std::vector<CubeColour> source_;
};

TEST_F(ColourIntegrity, BothLayoutsAreSound) {
  const std::string plain = folder_.file("plain.svdag"), compact = folder_.file("compact.svdag");
  write_compact(DagFile::open(plain), compact, room_);
  EXPECT_EQ(defects_of(painted(plain)), std::vector<std::string>());
  EXPECT_EQ(defects_of(painted(compact)), std::vector<std::string>());
}

TEST_F(ColourIntegrity, AnotherColourIsFoundByTheHash) {
  std::string bytes = painted(folder_.file("plain.svdag"));
  const Header h = header_of(bytes);
  bytes[h.directory_offset + h.directory_bytes - 8] ^= 1;  // of the last, uniform, entry
  EXPECT_EQ(defects_of(bytes), std::vector<std::string>{"the colours do not match their hash"});
}

TEST_F(ColourIntegrity, AWrongMeanIsFound) {
  std::string bytes = painted(folder_.file("plain.svdag"));
  Header h = header_of(bytes);
  auto* const entries = reinterpret_cast<ColourEntry*>(bytes.data() + h.directory_offset);
  // The first entry is the mean of the whole grid.
  ASSERT_EQ(entries[0].value & kChunkEntry, 0u);
  ASSERT_EQ(entries[1].first, 1u);
  const auto with_mean = [&](uint64_t mean) {
    entries[0].value = mean;
    Hasher128 hasher;
    hasher.update(std::as_bytes(std::span(&h.colour_count, 1)));
    hasher.update(std::as_bytes(std::span(&h.colour_level, 1)));
    hasher.update(std::as_bytes(std::span(&h.colour_error, 1)));
    const auto part = [&](uint64_t offset, uint64_t size) {
      hasher.update(std::as_bytes(std::span(bytes)).subspan(size_t(offset), size_t(size)));
    };
    part(h.chunks_offset, h.chunks_bytes);
    part(h.directory_offset, h.directory_bytes);
    const Hash128 hash = hasher.digest();
    std::ranges::copy(hash, h.colour_hash);
    std::memcpy(bytes.data(), &h, sizeof h);
    return defects_of(bytes);
  };
  const std::vector<std::string> wrong = {
      "the colours of 1 coarser cube are not the mean of those inside"};
  const uint64_t mean = entries[0].value;
  EXPECT_EQ(with_mean(mean), std::vector<std::string>());
  EXPECT_EQ(with_mean(mean ^ 0x80), wrong);
  EXPECT_EQ(with_mean(kNoColour), wrong);
}

TEST_F(ColourIntegrity, EntriesOfNoCubeAreFound) {
  const std::string good = painted(folder_.file("plain.svdag"));
  const Header h = header_of(good);
  size_t tried = 0;
  for (uint64_t i = 1; i * sizeof(ColourEntry) < h.directory_bytes; ++i) {
    std::string bytes = good;
    auto* const entry = reinterpret_cast<ColourEntry*>(bytes.data() + h.directory_offset) + i;
    if (((entry - 1)->value & kChunkEntry) != 0 || (entry->value & kChunkEntry) != 0) continue;
    ++entry->first;
    if (i + 1 < h.directory_bytes / sizeof(ColourEntry) && entry->first == (entry + 1)->first)
      continue;
    ++tried;
    const auto defects = defects_of(bytes);
    EXPECT_EQ(defects.back(), "the directory of the colours does not divide the cubes of the DAG");
  }
  EXPECT_GT(tried, 0U);
}

TEST_F(ColourIntegrity, AnotherGeometryIsFound) {
  std::string bytes = painted(folder_.file("plain.svdag"));
  Header h = header_of(bytes);
  h.content_hash[0] ^= 1;
  std::memcpy(bytes.data(), &h, sizeof h);
  EXPECT_SVDAG_ERROR(defects_of(bytes), ExitCode::kBadInput,
                     "its nodes do not match its content hash");
}

TEST_F(ColourIntegrity, ColoursOfOtherCubesAreNotLookedUp) {
  std::string bytes = painted(folder_.file("plain.svdag"));
  Header h = header_of(bytes);
  --h.colour_level;
  std::memcpy(bytes.data(), &h, sizeof h);
  EXPECT_SVDAG_ERROR(defects_of(bytes), ExitCode::kBadInput, "colours for");
}

}  // namespace
}  // namespace svdag
