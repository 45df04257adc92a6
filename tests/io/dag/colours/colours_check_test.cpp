// Tests that no damaged colours are accepted by the reader, and that what is accepted can be looked
// up: with repaired checksums, as a hostile writer would make them.
#include "io/dag/colours/colours_check.h"

#include <gtest/gtest.h>

#include <random>

#include "io/dag/colours/dag_colours.h"
#include "streaming/error.h"
#include "tests/expect_error.h"
#include "tests/io/dag/colours/coloured_voxels.h"
#include "tests/memory_file.h"
#include "tests/repair_checksums.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

class ColoursCheck : public testing::Test {
 protected:
  ColoursCheck() {
    VoxelSet voxels = bodies(5, 2);
    add_box(&voxels, {LatticePoint(0), LatticePoint(32, 32, 24)});
    const TempFolder folder;
    RawFile(raw_dag(test_grid(5), voxels)).write(folder.file("a.svdag"));
    const auto source = source_of(coloured_cubes(voxels, 5, 5, mixed_colours(16)), 5, 9);
    MemoryBudget budget;
    SequentialExecutor executor;
    write_coloured(DagFile::open(folder.file("a.svdag")), {5, 9 * kColourErrorUnit},
                   in_parts(source, 500), folder.file("b.svdag"), {&budget, folder.path()},
                   &executor);
    good_ = read_bytes(folder.file("b.svdag"));
    std::memcpy(&header_, good_.data(), sizeof header_);
  }
  // Opens the file with repaired checksums and looks up the ends of all entries.
  static void open(std::string bytes) {
    repair_checksums(&bytes);
    const MemoryFile memory(bytes);
    const DagFile file = DagFile::open(memory.file().path());
    MemoryBudget budget;
    const DagColours colours(file, &budget);
    for (uint64_t i = 0; i < file.header().colour_count; i += 97) colour_at(colours.view(), i);
  }
  void expect_defect(const std::string& bytes, const char* sentence) {
    EXPECT_SVDAG_ERROR(open(bytes), ExitCode::kBadInput, sentence);
  }
  template <class T>
  std::string with(uint64_t offset, T value) const {
    std::string bytes = good_;
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    return bytes;
  }
  // The entries of the directory.
  const ColourEntry* entries() const {
    return reinterpret_cast<const ColourEntry*>(good_.data() + header_.directory_offset);
  }
  uint64_t first_chunk() const {
    uint64_t i = 0;
    while ((entries()[i].value & kChunkEntry) == 0) ++i;
    return i;
  }

  std::string good_;
  Header header_;
};

TEST_F(ColoursCheck, EachDefectHasItsSentence) {
  open(good_);
  const uint64_t directory = header_.directory_offset, chunks = header_.chunks_offset;
  const uint64_t chunk = directory + first_chunk() * sizeof(ColourEntry);
  const auto word = [&](uint64_t i) {
    uint32_t value;
    std::memcpy(&value, good_.data() + chunks + 4 * i, 4);
    return value;
  };
  expect_defect(with(offsetof(Header, colour_level), 6U), "impossible colours");
  expect_defect(with(offsetof(Header, colour_error), kMaxColourError + 1), "impossible colours");
  expect_defect(with(offsetof(Header, colour_level), 0U), "impossible layout");
  expect_defect(with(offsetof(Header, colour_level), 4U), "colours for");
  expect_defect(with(offsetof(Header, colour_count), uint64_t(1) << 60), "");
  expect_defect(with(offsetof(Header, chunks_offset), header_.chunks_offset + 64), "wrong offset");
  expect_defect(with(directory, uint64_t(1)), "does not begin with the first");
  expect_defect(with(directory + 16, uint64_t(0)), "do not ascend");
  expect_defect(with(directory + 8, uint64_t(1) << 24), "an impossible colour");
  expect_defect(with(chunk + 8, kChunkEntry | 1), "belong to no chunk");
  expect_defect(with(chunk + 8, kChunkEntry | ~uint64_t(0)), "belong to no chunk");
  expect_defect(with(chunks, 0U), "impossible number of runs");
  expect_defect(with(chunks, kChunkColours + 1), "impossible number of runs");
  expect_defect(with(chunks, word(0) + 16), "");
  expect_defect(with(chunks, word(0) - 1), "");
  expect_defect(with(chunks + 4, word(1) + 1), "wrong place");
  const uint32_t headers = 1 + chunk_groups(word(0));
  expect_defect(with(chunks + 4 * headers, word(headers) ^ 1), "");
}

TEST_F(ColoursCheck, DamagedBytesAreFoundOrHarmless) {
  std::mt19937_64 random(3);
  const uint64_t begin = header_.chunks_offset, end = header_.metadata_offset;
  size_t found = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string bytes = good_;
    for (uint64_t n = 1 + random() % 3; n > 0; --n) {
      const uint64_t at = random() % 4 == 0 ? offsetof(Header, chunks_offset) + random() % 64
                                            : begin + random() % (end - begin);
      bytes[at] = char(random() % 3 == 0 ? random() : uint64_t(bytes[at]) ^ 1 << random() % 8);
    }
    try {
      open(bytes);
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ExitCode::kBadInput);
      ++found;
    }
  }
  EXPECT_GT(found, 1000U);
}

TEST_F(ColoursCheck, EveryFlippedBitIsFoundByTheChecksums) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 300; ++i) {
    std::string bytes = good_;
    bytes[random() % bytes.size()] ^= char(1 << random() % 8);
    const MemoryFile memory(bytes);
    EXPECT_THROW(DagFile::open(memory.file().path()), Error);
  }
}

}  // namespace
}  // namespace svdag
