// A run file is read back as it was written; any other file is rejected.
#include "builder/run/run_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <optional>

#include "builder/run/run_check.h"
#include "builder/run/run_writer.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

Grid small_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.voxel_size = 0.25;
  grid.origin = Point(1, -2, 0.5);
  grid.selection = grid.whole();
  return grid;
}

// Adds keys to the level; returns the rank of the first.
template <class Key>
uint32_t add(const std::vector<Key>& keys, RunWriter* writer) {
  LevelPiece piece;
  writer->encode(std::span<const Key>(keys), &piece);
  const uint32_t first = writer->append(&piece);
  writer->store(&piece);
  return first;
}

// Two bricks and two nodes: cells 1 and 4 of level 1 have roots, cells 2 and 3 are empty.
void write_small(const std::string& path) {
  RunWriter writer(path, small_grid(4), Rule::kThin, GridPart::of_cells({1, 1, 5}, 4));
  writer.begin_level(2);
  EXPECT_EQ(add<Brick>({7}, &writer), 0U);
  EXPECT_EQ(add<Brick>({9}, &writer), 1U);
  writer.begin_level(1);
  EXPECT_EQ(add<NodeKey>({{0, 1, 0, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 2, 0, 0, 0}}, &writer), 0U);
  writer.begin_level(0);
  writer.finish(std::vector<SubDagRoot>{{4, 1, 0, 0}, {1, 1, 0, 1}}, 8, 0.125, {});
}

// Reads a run as a merge does.
void read_all(const std::string& path, uint64_t bitmap_bytes = 1 << 20) {
  MemoryBudget budget(1 << 22);
  const RunFile run = RunFile::open(path, &budget);
  check_run(run, bitmap_bytes, &budget);
}

template <class Key>
std::vector<Key> keys_of(const RunFile& run, int level, MemoryBudget* budget) {
  std::vector<Key> keys;
  const auto blocks = run.read(level, budget);
  for (auto block = blocks->next(); !block.empty(); block = blocks->next()) {
    const auto* at = reinterpret_cast<const Key*>(block.data());
    keys.insert(keys.end(), at, at + block.size() / sizeof(Key));
  }
  return keys;
}

TEST(RunFile, HoldsWhatWasWritten) {
  const TempFolder folder;
  const std::string path = folder.file("a.run");
  write_small(path);
  read_all(path);
  MemoryBudget budget;
  const RunFile run = RunFile::open(path, &budget);
  EXPECT_EQ(run.grid(), small_grid(4));
  EXPECT_EQ(run.rule(), Rule::kThin);
  EXPECT_EQ(run.header().voxels, 8U);
  EXPECT_EQ(run.header().largest_snap, 0.125);
  EXPECT_EQ(run.part().ranges(), (std::vector<MortonRange>{{512, 5 * 512}}));
  EXPECT_EQ(keys_of<Brick>(run, 2, &budget), (std::vector<Brick>{7, 9}));
  EXPECT_EQ(keys_of<NodeKey>(run, 1, &budget).size(), 2U);
  EXPECT_EQ(keys_of<NodeKey>(run, 0, &budget).size(), 0U);
  ASSERT_EQ(run.roots().size(), 2U);  // in Morton order
  EXPECT_EQ(run.roots()[0].morton, 1U);
  EXPECT_EQ(run.roots()[0].rank, 1U);
  EXPECT_EQ(run.roots()[1].morton, 4U);
}

TEST(RunFile, LevelsOfManyBlocksBeginAndEndWithinThem) {
  const TempFolder folder;
  const std::string path = folder.file("a.run");
  RunWriter writer(path, small_grid(4), Rule::kConservative, GridPart::whole(4));
  const uint32_t bricks = 30'001, nodes = 9'003;
  writer.begin_level(2);
  std::vector<Brick> brick_keys;
  for (uint32_t i = 0; i < bricks; ++i) brick_keys.push_back(3 * i + 1);
  add(brick_keys, &writer);
  writer.begin_level(1);
  std::vector<NodeKey> node_keys;
  for (uint32_t i = 0; i < nodes; ++i) node_keys.push_back({i, 1, 0, 0, 0, 0, 0, bricks});
  add(node_keys, &writer);
  writer.begin_level(0);
  add<NodeKey>({{1, 0, nodes, 0, 0, 0, 0, 0}}, &writer);
  writer.finish(std::vector<SubDagRoot>{{0, 0, 0, 0}}, 1, 0, {});
  MemoryBudget budget;
  const RunFile run = RunFile::open(path, &budget);
  EXPECT_EQ(run.layout().blocks, 9U);
  const auto read_bricks = keys_of<Brick>(run, 2, &budget);
  ASSERT_EQ(read_bricks.size(), bricks);
  for (uint32_t i = 0; i < bricks; ++i) ASSERT_EQ(read_bricks[i], 3 * i + 1);
  const auto read_nodes = keys_of<NodeKey>(run, 1, &budget);
  ASSERT_EQ(read_nodes.size(), nodes);
  for (uint32_t i = 0; i < nodes; ++i) ASSERT_EQ(read_nodes[i][0], i);
  EXPECT_EQ(keys_of<NodeKey>(run, 0, &budget).front()[2], nodes);
  // Not every brick has a parent: an error, also with a bitmap smaller than the level.
  for (const uint64_t bytes : {1 << 20, 100, 1})
    EXPECT_SVDAG_ERROR(read_all(path, bytes), ExitCode::kBadInput, "not reached from any root");
}

TEST(RunFile, EveryFlippedBitIsFound) {
  const TempFolder folder;
  const std::string path = folder.file("a.run");
  write_small(path);
  std::string bytes = folder.read("a.run");
  ASSERT_LT(bytes.size(), 2048U);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const auto put = [&](size_t at) {
    file.seekp(std::streamoff(at));
    file.put(bytes[at]).flush();
  };
  for (size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= char(1 << bit % 8);
    put(bit / 8);
    EXPECT_SVDAG_ERROR(read_all(path), ExitCode::kBadInput, path);
    bytes[bit / 8] ^= char(1 << bit % 8);
    put(bit / 8);
  }
  read_all(path);
}

TEST(RunFile, EveryOtherLengthIsFound) {
  const TempFolder folder;
  write_small(folder.file("a.run"));
  const std::string bytes = folder.read("a.run");
  for (size_t length = 0; length < bytes.size(); ++length)
    EXPECT_SVDAG_ERROR(read_all(folder.write("b.run", bytes.substr(0, length))),
                       ExitCode::kBadInput, "b.run");
  EXPECT_SVDAG_ERROR(read_all(folder.write("b.run", bytes + '\0')), ExitCode::kBadInput,
                     "its size");
}

// A small run that a test changes, with checksums recomputed as a hostile writer would.
class Hostile {
 public:
  explicit Hostile(const TempFolder& folder) : path_(folder.file("h.run")) {
    write_small(path_);
    bytes_ = folder.read("h.run");
    layout_.emplace(*header());
  }
  RunHeader* header() { return reinterpret_cast<RunHeader*>(bytes_.data()); }
  template <class Item>
  Item* at(uint64_t position) {
    return reinterpret_cast<Item*>(bytes_.data() + sizeof(RunHeader) + kSpillHeader + position);
  }
  template <class Item>
  Item* at(const RunSection& section) {
    return at<Item>(section.begin);
  }
  const RunLayout& layout() const { return *layout_; }  // before the change

  std::string repaired() {
    RunHeader* h = header();
    const size_t ranges = size_t(h->ranges);
    if (h->ranges < 10) {
      const std::span<StoredRange> stored(at<StoredRange>(layout().ranges), ranges);
      h->run = run_number(*h, stored);
    }
    const auto block = std::as_writable_bytes(std::span(bytes_)).subspan(sizeof(RunHeader));
    const uint64_t sum = seal_block(block, {h->run, 0, uint32_t(block.size() - kSpillHeader)});
    Hasher128 hasher;
    hasher.update(std::as_bytes(std::span(&sum, 1)));
    const Hash128 hash = content_hash_of(*h, &hasher);
    std::copy(hash.begin(), hash.end(), h->content_hash);
    h->header_checksum = checksum_of(*h);
    std::ofstream(path_, std::ios::binary) << bytes_;
    return path_;
  }

 private:
  std::string path_, bytes_;
  std::optional<RunLayout> layout_;
};

TEST(RunFile, AHostileFileIsRejectedWithItsFault) {
  const TempFolder folder;
  read_all(Hostile(folder).repaired());
  using Change = std::function<void(Hostile*)>;
  const std::pair<const char*, Change> changes[] = {
      {"the number of levels", [](Hostile* h) { h->header()->levels = 21; }},
      {"wrong lattice fraction", [](Hostile* h) { h->header()->fraction = 5; }},
      {"unknown rule", [](Hostile* h) { h->header()->rule = 5; }},
      {"unknown kind of grid", [](Hostile* h) { h->header()->grid_kind = 3; }},
      {"impossible voxel size", [](Hostile* h) { h->header()->voxel_size = -1; }},
      {"impossible grid corner", [](Hostile* h) { h->header()->origin[1] = 1.0 / 0.0; }},
      {"impossible grid corner", [](Hostile* h) { h->header()->k0[1] = 1024; }},
      {"impossible flag", [](Hostile* h) { h->header()->bounded = 2; }},
      {"impossible selection", [](Hostile* h) { h->header()->selection_max[0] = 17; }},
      {"wrong header size", [](Hostile* h) { h->header()->header_bytes = 0; }},
      {"wrong block size", [](Hostile* h) { h->header()->block_bytes = 64; }},
      {"impossible number of voxels", [](Hostile* h) { h->header()->voxels = 1 << 20; }},
      {"impossible snap move", [](Hostile* h) { h->header()->largest_snap = -1; }},
      {"impossible number of nodes", [](Hostile* h) { h->header()->keys[1] = 0xfffffff0; }},
      {"the file size does not match the counts", [](Hostile* h) { h->header()->keys[1] = 3; }},
      {"unused level", [](Hostile* h) { h->header()->keys[7] = 1; }},
      {"impossible number of ranges", [](Hostile* h) { h->header()->ranges = 1ULL << 60; }},
      {"impossible number of roots", [](Hostile* h) { h->header()->roots = 1ULL << 60; }},
      {"unknown header field", [](Hostile* h) { h->header()->reserved[5] = 1; }},
      {"has run format version 2", [](Hostile* h) { h->header()->version = 2; }},
      {"impossible range", [](Hostile* h) { h->at<StoredRange>(h->layout().ranges)->end = 4097; }},
      {"impossible range",
       [](Hostile* h) { h->at<StoredRange>(h->layout().ranges)->end = 1 << 20; }},
      {"impossible range",
       [](Hostile* h) { h->at<StoredRange>(h->layout().ranges)->begin = 4096; }},
      {"a root is not a top of the part",
       [](Hostile* h) { h->at<StoredRange>(h->layout().ranges)->begin = 0x440; }},
      {"impossible root", [](Hostile* h) { h->at<StoredRoot>(h->layout().roots)->rank = 2; }},
      {"impossible root",
       [](Hostile* h) { h->at<StoredRoot>(h->layout().roots)->level_and_set = 3; }},
      {"impossible root",
       [](Hostile* h) { h->at<StoredRoot>(h->layout().roots)->level_and_set = UINT32_MAX; }},
      {"impossible root", [](Hostile* h) { h->at<StoredRoot>(h->layout().roots)->code = 8; }},
      {"a root is not a top of the part",
       [](Hostile* h) { h->at<StoredRoot>(h->layout().roots)->code = 5; }},
      {"a root is not a top of the part",
       [](Hostile* h) { h->at<StoredRoot>(h->layout().roots)->code = 4; }},
      {"do not ascend", [](Hostile* h) { *h->at<Brick>(h->layout().levels[2]) = 9; }},
      {"do not ascend", [](Hostile* h) { *h->at<Brick>(h->layout().levels[2]) = 0; }},
      {"do not ascend", [](Hostile* h) { h->at<NodeKey>(h->layout().levels[1])->at(0) = 1; }},
      {"a child is outside",
       [](Hostile* h) { (h->at<NodeKey>(h->layout().levels[1]) + 1)->at(4) = 3; }},
      {"not reached", [](Hostile* h) { (h->at<NodeKey>(h->layout().levels[1]) + 1)->at(4) = 1; }},
      {"not reached", [](Hostile* h) { h->at<StoredRoot>(h->layout().roots)->rank = 0; }},
      {"the gap between", [](Hostile* h) { *h->at<char>(h->layout().levels[2].end) = 1; }},
  };
  for (const auto& [sentence, change] : changes) {
    Hostile hostile(folder);
    change(&hostile);
    EXPECT_SVDAG_ERROR(read_all(hostile.repaired()), ExitCode::kBadInput, sentence);
  }
}

TEST(RunFile, OtherFilesAreRejected) {
  const TempFolder folder;
  for (const std::string& bytes :
       {std::string(), std::string(5000, 'x'), std::string("\x89SVDAG\r\n")})
    EXPECT_SVDAG_ERROR(read_all(folder.write("x.run", bytes)), ExitCode::kBadInput, "is not a run");
}

TEST(RunFile, DamageAfterOpeningIsFoundByTheReader) {
  const TempFolder folder;
  write_small(folder.file("a.run"));
  MemoryBudget budget;
  const RunFile run = RunFile::open(folder.file("a.run"), &budget);
  std::string bytes = folder.read("a.run");
  bytes[sizeof(RunHeader) + kSpillHeader] ^= 1;
  folder.write("a.run", bytes);
  EXPECT_SVDAG_ERROR(run.read(2, &budget)->next(), ExitCode::kBadInput,
                     "does not match its checksum");
}

}  // namespace
}  // namespace svdag
