// Tests that the compact layout holds the same DAG as the plain one in one only way: files convert
// to and fro byte for byte, views agree, and every changed bit is found, with and without repaired
// checksums.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>

#include "io/dag/compact/compact_classes.h"
#include "io/dag/compact/compact_writer.h"
#include "io/dag/dag_stats.h"
#include "io/dag/graph/select.h"
#include "streaming/error.h"
#include "tests/expect_error.h"
#include "tests/repair_checksums.h"
#include "tests/temp_folder.h"
#include "tests/verify/raw_dag.h"
#include "verify/integrity/integrity.h"

namespace svdag {
namespace {

// Voxels of sheets that repeat, with noise: shared and private nodes on all levels.
VoxelSet voxels_of(int levels, uint64_t seed) {
  std::mt19937_64 random(seed);
  VoxelSet voxels;
  const int64_t side = int64_t(1) << levels;
  for (int64_t x = 0; x < side; ++x) {
    for (int64_t y = 0; y < side; ++y) voxels.emplace(x, y, (x / 3 + y / 5) % side);
  }
  for (int i = 0; i < 200; ++i) voxels.emplace(random() % side, random() % side, random() % side);
  return voxels;
}

class Compact : public ::testing::Test {
 protected:
  DagFile plain(int levels, const VoxelSet& voxels) {
    const std::string path = folder_.file("plain.svdag");
    RawFile(raw_dag(test_grid(levels), voxels)).write(path);
    return DagFile::open(path);
  }
  DagFile compact(const DagFile& plain) {
    const std::string path = folder_.file("compact.svdag");
    write_compact(plain, path, room_);
    return DagFile::open(path);
  }

  const TempFolder folder_;
  MemoryBudget budget_;
  WorkRoom room_{&budget_, folder_.path()};
};

TEST_F(Compact, HasTheVoxelsAndTheCountsOfThePlainLayout) {
  for (const int levels : {3, 4, 6, 7}) {
    const DagFile a = plain(levels, voxels_of(levels, uint64_t(levels)));
    const DagFile b = compact(a);
    ASSERT_EQ(b.layout(), Layout::kCompact);
    const uint32_t side = a.view().resolution();
    for (uint32_t x = 0; x < side; ++x) {
      for (uint32_t y = 0; y < side; ++y) {
        for (uint32_t z = 0; z < side; ++z)
          ASSERT_EQ(dag_voxel(a.view(), x, y, z), dag_voxel(b.view(), x, y, z));
      }
    }
    const DagStats of_a = compute_stats(a), of_b = compute_stats(b);
    EXPECT_EQ(of_a.voxels, of_b.voxels);
    EXPECT_EQ(of_a.svo_nodes(), of_b.svo_nodes());
    EXPECT_EQ(of_a.dag_nodes(), of_b.dag_nodes());
  }
}

TEST_F(Compact, ConvertsToAndFroByteForByteAndIsSound) {
  for (const int levels : {3, 5, 7}) {
    for (const VoxelSet& voxels : {VoxelSet{}, VoxelSet{{1, 2, 3}}, voxels_of(levels, 9)}) {
      const DagFile a = plain(levels, voxels);
      const DagFile b = compact(a);
      EXPECT_TRUE(is_compact_form(b, a, room_));
      EXPECT_TRUE(inspect_file(b, room_).sound());
      EXPECT_TRUE(std::equal(a.header().content_hash, a.header().content_hash + 2,
                             b.header().content_hash));
      const std::vector<uint64_t> sizes = compact_section_bytes(a.view(), room_);
      for (size_t level = 0; level < sizes.size(); ++level)
        EXPECT_EQ(sizes[level], b.header().sections[level].bytes);
      const DagFile c = derive(b, {}, room_);
      EXPECT_TRUE(std::ranges::equal(a.bytes(), c.bytes()));
      EXPECT_TRUE(std::ranges::equal(a.bytes(), derive(a, {}, room_).bytes()));
    }
  }
}

TEST_F(Compact, HasTheSameBytesWithoutMemory) {
  const DagFile a = plain(8, voxels_of(8, 3));
  const DagFile b = compact(a);
  MemoryBudget little(1 << 20);
  const auto taken = little.reserve((1 << 20) - (1 << 17), "everything else");
  const WorkRoom room{&little, room_.folder};
  EXPECT_TRUE(is_compact_form(b, a, room));
}

TEST_F(Compact, ConvertsBackWithinASmallBudget) {
  const DagFile a = plain(8, voxels_of(8, 3));
  const DagFile b = compact(a);
  MemoryBudget small(4 << 20);
  const WorkRoom room{&small, room_.folder};
  EXPECT_TRUE(is_compact_form(b, a, room));
  EXPECT_TRUE(std::ranges::equal(a.bytes(), derive(b, {}, room).bytes()));
  EXPECT_LE(small.peak(), small.limit());
}

TEST_F(Compact, EveryFlippedBitIsFound) {
  const DagFile a = plain(4, voxels_of(4, 1));
  compact(a);
  const std::string good = folder_.read("compact.svdag");
  const std::string bad_path = folder_.file("bad.svdag");
  for (size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = char(bad[i] ^ (1 << i % 8));
    folder_.write("bad.svdag", bad);
    EXPECT_SVDAG_ERROR(DagFile::open(bad_path), ExitCode::kBadInput, "");
  }
}

// What a hostile writer could do: only the proof of the whole file can find it.
TEST_F(Compact, EveryChangedBitIsFoundAlthoughItsChecksumsAreRepaired) {
  const DagFile a = plain(4, voxels_of(4, 1));
  compact(a);
  const std::string good = folder_.read("compact.svdag");
  const std::string bad_path = folder_.file("bad.svdag");
  size_t opened = 0;
  Header h;
  std::memcpy(&h, good.data(), sizeof h);
  for (size_t i = 0; i < h.checksum_offset; ++i) {
    for (int bit = 0; bit < 8; bit += i < sizeof h ? 1 : 3) {
      std::string bad = good;
      bad[i] = char(bad[i] ^ (1 << bit));
      repair_checksums(&bad);
      if (bad == good) continue;  // a checksum
      folder_.write("bad.svdag", bad);
      try {
        const DagFile file = DagFile::open(bad_path);
        ++opened;
        EXPECT_FALSE(inspect_file(file, room_).sound()) << "byte " << i << ", bit " << bit;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
      }
    }
  }
  EXPECT_GT(opened, 100U);
}

// All divisions into the most referenced, the next, and the rest, tried one by one.
uint64_t least_bytes(std::vector<uint32_t> references, uint64_t nodes) {
  std::sort(references.rbegin(), references.rend());
  const size_t own = size_t(std::count(references.begin(), references.end(), 1));
  const size_t all = references.size();
  const auto width = [](size_t count) {
    return count < 2 ? 0U : uint32_t(std::bit_width(count - 1));
  };
  uint64_t least = UINT64_MAX;
  for (const bool is_private : {true, false}) {
    const size_t listed = is_private ? all - own : all;
    for (size_t a = is_private ? 0 : 1; a <= (is_private ? 0 : listed); ++a) {
      for (size_t b = 0; a + b <= listed; ++b) {
        CompactEntry e{};
        e.kind = is_private ? 0 : 1;
        const size_t end[] = {0, a, a + b, listed};
        for (uint32_t s = 0; s < kClasses; ++s) {
          for (size_t i = end[s]; i < end[s + 1]; ++i) e.references[s] += references[i];
          e.widths[s] = width(end[s + 1] - end[s]);
        }
        if (is_private) e.references[0] = own;
        least = std::min(least, compact_bytes(e, nodes));
      }
    }
  }
  return least;
}

TEST(NodeClasses, TakeTheFewestBytes) {
  std::mt19937_64 random(4);
  for (int round = 0; round < 40; ++round) {
    const uint32_t most = 1 + uint32_t(random() % 2000);
    std::vector<uint32_t> references(1 + random() % 120);
    for (uint32_t& r : references) r = random() % 3 == 0 ? 1 : 1 + uint32_t(random() % most);
    ReferenceCounts counts;
    for (const uint32_t r : references) counts.add(r);
    NodeClasses classes(counts, 50);
    const CompactEntry e = classes.entry();
    EXPECT_EQ(compact_bytes(e, 50), least_bytes(references, 50));
    uint64_t sizes[kClasses] = {}, sums[kClasses] = {};
    for (const uint32_t r : references) {
      const uint32_t s = classes.class_of(r);
      ++sizes[s];
      sums[s] += r;
    }
    for (uint32_t s = 0; s < kClasses; ++s) {
      EXPECT_EQ(sizes[s], e.sizes[s]);
      EXPECT_EQ(sums[s], e.references[s]);
    }
  }
}

}  // namespace
}  // namespace svdag
