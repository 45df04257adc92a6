// Tests that a packed file unpacks to the same bytes, and that no damaged one is accepted.
#include "io/dag/pack/pack.h"
#include "io/dag/open_dag.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <random>

#include "io/dag/pack/node_streams.h"
#include "io/dag/pack/pack_format.h"
#include "io/dag/pack/unpack.h"
#include "io/dag/write/dag_writer.h"
#include "tests/expect_error.h"
#include "tests/io/dag/colours/painted_cubes.h"
#include "tests/repair_packed.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

// Ascending keys whose neighbours are alike, like those of a level.
std::vector<NodeKey> some_nodes(size_t count, uint32_t below, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<NodeKey> nodes;
  NodeKey node{};
  for (size_t i = 0; i < count; ++i) {
    for (uint32_t& child : node) {
      switch (random() % 8) {
        case 0:
          child = 0;
          break;
        case 1:
          child = 1 + uint32_t(random() % below);
          break;
        case 2:
          child = std::min(child + 1, below);
          break;
        default:
          break;
      }
    }
    if (node == NodeKey{}) node[7] = below;
    nodes.push_back(node);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<NodeKey> keys_of(const ChunkNodes& nodes) {
  std::vector<NodeKey> keys;
  const uint32_t* children = nodes.children.data();
  for (const unsigned char mask : nodes.masks) {
    keys.push_back(key_of(mask, children));
    children += kChildCounts[mask];
  }
  EXPECT_EQ(children + 8, nodes.children.data() + nodes.children.size());
  return keys;
}

class Pack : public ::testing::Test {
 protected:
  // A valid plain file; more than one chunk per level if `width` is large.
  DagFile plain(int levels, size_t width) {
    Grid grid;
    grid.levels = levels;
    grid.selection = grid.whole();
    const std::string path = folder_.file("plain.svdag");
    DagWriter writer(path, grid, Rule::kConservative);
    std::vector<uint32_t> below;
    writer.begin_level(levels - 2);
    for (size_t i = 0; i < width; ++i) below.push_back(writer.add_brick(1 + 3 * i));
    for (int level = levels - 3; level >= 0; --level) {
      writer.begin_level(level);
      const size_t count = level == 0 ? std::min<size_t>(1, width) : width;
      const std::vector<NodeKey> nodes =
          width == 0 ? std::vector<NodeKey>() : some_nodes(count, uint32_t(below.size()), 7);
      std::vector<uint32_t> here;
      for (NodeKey node : nodes) {
        for (uint32_t& child : node) child = child == 0 ? 0 : 1 + below[child - 1];
        here.push_back(writer.add_node(node));
      }
      below = std::move(here);
    }
    writer.finish(42, 0.25);
    return DagFile::open(path);
  }
  // The same with colours, some of them in chunks.
  DagFile painted(const DagFile& plain) {
    const uint32_t level = plain.view().levels;
    PaintedCubes cubes(plain.view(), level, mixed_paint(2));
    const std::string path = folder_.file("painted.svdag");
    write_coloured(plain, {level, 9 * kColourErrorUnit}, cubes.source(), path, room_, &executor_);
    return DagFile::open(path);
  }
  std::string packed(const DagFile& plain, int level = 1, Executor* executor = nullptr) {
    SequentialExecutor one;
    pack(plain, folder_.file("a.pack"), level, &budget_, executor != nullptr ? executor : &one);
    return folder_.read("a.pack");
  }
  DagFile unpacked() { return unpack(folder_.file("a.pack"), room_, &executor_); }

  static uint32_t version(const std::string& packed) {
    PackedHeader header;
    std::memcpy(&header, packed.data(), sizeof header);
    return header.version;
  }

  const TempFolder folder_;
  MemoryBudget budget_;
  WorkRoom room_{&budget_, folder_.path()};
  ParallelExecutor executor_{2};
};

TEST(NodeStreams, GiveBackTheNodes) {
  for (const size_t count : {0, 1, 2, 1000, 16384}) {
    const std::vector<NodeKey> nodes = some_nodes(count, 5000, count);
    ChunkNodes again{{7}, {7}, false};  // is overwritten
    ASSERT_TRUE(nodes_of_streams(streams_of_nodes(nodes), nodes.size(), 5000, &again));
    EXPECT_EQ(keys_of(again), nodes);
    EXPECT_TRUE(again.ascend);
  }
}

TEST(NodeStreams, OfAnyBytesGiveNodesInRangeAndKnowTheirOrderOrNone) {
  std::mt19937_64 random(3);
  size_t accepted = 0, descending = 0;
  for (int round = 0; round < 3000; ++round) {
    const std::vector<NodeKey> nodes = some_nodes(50, 200, uint64_t(round));
    auto streams = streams_of_nodes(nodes);
    for (int i = 0; i < 2; ++i) {
      Stream& stream = streams[random() % streams.size()];
      if (!stream.empty()) stream[random() % stream.size()] ^= uint8_t(1 << random() % 8);
      if (random() % 16 == 0 && !stream.empty()) stream.pop_back();
    }
    if (round % 2 == 0) {  // instead, one node loses its children that are equal to those before
      streams = streams_of_nodes(nodes);
      Stream &masks = streams[0], &equal = streams[1];
      const size_t n = random() % nodes.size();
      masks[n] = static_cast<unsigned char>(masks[n] & ~equal[n]);
      equal[n] = 0;
    }
    ChunkNodes again;
    if (!nodes_of_streams(streams, nodes.size(), 200, &again)) continue;
    ++accepted;
    const std::vector<NodeKey> keys = keys_of(again);
    for (const NodeKey& node : keys) {
      for (const uint32_t child : node) ASSERT_LE(child, 200U);
    }
    const bool ascend =
        keys.front() != NodeKey{} && std::ranges::is_sorted(keys, std::less_equal());
    ASSERT_EQ(again.ascend, ascend);
    descending += !ascend;
  }
  EXPECT_GT(accepted, 50U);
  EXPECT_GT(descending, 20U);
}

TEST_F(Pack, UnpacksToTheSameBytes) {
  const auto expect_same = [&](const DagFile& file) {
    const std::string bytes = packed(file);
    EXPECT_EQ(version(bytes), file.has_colours() ? 2U : 1U);
    EXPECT_TRUE(std::ranges::equal(unpacked().bytes(), file.bytes()));
    EXPECT_EQ(packed(file, 1, &executor_), bytes) << "threads change the bytes";
    const Header header =
        unpack_to(folder_.file("a.pack"), folder_.file("b.svdag"), room_, &executor_);
    EXPECT_TRUE(std::ranges::equal(DagFile::open(folder_.file("b.svdag")).bytes(), file.bytes()));
    EXPECT_EQ(header.file_bytes, file.bytes().size());
    EXPECT_TRUE(is_packed(folder_.file("a.pack")));
    EXPECT_FALSE(is_packed(folder_.file("b.svdag")));
    EXPECT_TRUE(std::ranges::equal(open_dag(folder_.file("a.pack")).bytes(), file.bytes()));
  };
  for (const auto& [levels, width] :
       std::vector<std::pair<int, size_t>>{{3, 0}, {3, 1}, {4, 20}, {7, 300}, {6, 40'000}}) {
    const DagFile file = plain(levels, width);
    expect_same(file);
    expect_same(painted(file));
  }
}

TEST_F(Pack, NeedsNoMoreThanItsMemory) {
  const DagFile file = plain(6, 40'000);
  MemoryBudget little(1000);
  SequentialExecutor one;
  EXPECT_SVDAG_ERROR(pack(file, folder_.file("a.pack"), 1, &little, &one), ExitCode::kMemory,
                     "numbers of nodes");
  EXPECT_FALSE(std::filesystem::exists(folder_.file("a.pack")));
}

TEST_F(Pack, EveryFlippedBitIsFoundAndLeavesNoFile) {
  const std::string good = packed(painted(plain(4, 20)));
  for (size_t i = sizeof kPackedMagic; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = char(bad[i] ^ (1 << i % 8));
    folder_.write("a.pack", bad);
    EXPECT_SVDAG_ERROR(
        unpack_to(folder_.file("a.pack"), folder_.file("b.svdag"), room_, &executor_),
        ExitCode::kBadInput, "");
  }
  folder_.write("a.pack", good.substr(0, good.size() - 1));
  EXPECT_SVDAG_ERROR(unpacked(), ExitCode::kBadInput, "the index is not at the end");
  EXPECT_FALSE(std::filesystem::exists(folder_.file("b.svdag")));
}

TEST_F(Pack, ADamagedChunkIsNamedByItsOffset) {
  std::string bad = packed(plain(4, 20));
  bad[sizeof(PackedHeader) + 100] ^= 1;
  folder_.write("a.pack", bad);
  EXPECT_SVDAG_ERROR(
      unpacked(), ExitCode::kBadInput,
      "a chunk does not match its checksum (at byte " + std::to_string(sizeof(PackedHeader)) + ")");
}

// A hole in a file takes no disk, but it would take memory.
TEST_F(Pack, AChunkLargerThanItsStreamsIsRefusedBeforeItIsRead) {
  const std::string good = packed(plain(4, 20));
  PackedHeader header;
  std::memcpy(&header, good.data(), sizeof header);
  ChunkEntry entry;
  std::memcpy(&entry, good.data() + header.index_offset, sizeof entry);
  const size_t hole = max_chunk_bytes(entry.nodes);
  std::string bad = good;
  bad.insert(sizeof header + entry.bytes, hole, '\0');
  header.index_offset += hole;
  std::memcpy(bad.data(), &header, sizeof header);
  for (uint64_t i = 0; i < header.chunks; ++i) {
    char* at = bad.data() + header.index_offset + i * sizeof entry;
    std::memcpy(&entry, at, sizeof entry);
    if (i == 0) {
      entry.bytes += uint32_t(hole);
    } else {
      entry.offset += hole;
    }
    std::memcpy(at, &entry, sizeof entry);
  }
  repair_packed(&bad);
  folder_.write("a.pack", bad);
  EXPECT_SVDAG_ERROR(unpacked(), ExitCode::kBadInput, "an impossible entry of the index");
}

// A frame may hold the same streams in other bits.
TEST_F(Pack, WithRepairedChecksumsAFlippedBitIsFoundOrChangesNothing) {
  const DagFile file = painted(plain(4, 20));
  const std::string good = packed(file);
  size_t found = 0;
  for (size_t i = sizeof kPackedMagic; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = char(bad[i] ^ (1 << i % 8));
    repair_packed(&bad);
    if (bad == good) continue;  // a checksum
    folder_.write("a.pack", bad);
    try {
      EXPECT_TRUE(std::ranges::equal(unpacked().bytes(), file.bytes())) << "byte " << i;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
      ++found;
    }
  }
  EXPECT_GT(found, good.size() / 2);
}

}  // namespace
}  // namespace svdag
