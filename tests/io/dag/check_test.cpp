// Tests that no damaged file is accepted: every flipped bit, every truncation, every appended
// length.
#include "io/dag/check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <span>

#include "io/dag/dag_file.h"
#include "io/dag/write/dag_writer.h"
#include "streaming/error.h"
#include "tests/expect_error.h"
#include "tests/repair_checksums.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

// Writes a file of about 16 KiB with random sorted nodes on every level.
std::string make_file(const std::string& path, int levels = 6, size_t width = 180) {
  Grid grid;
  grid.levels = levels;
  grid.selection = grid.whole();
  DagWriter writer(path, grid, Rule::kConservative);
  std::mt19937_64 random(5);
  std::vector<uint32_t> below;
  writer.begin_level(levels - 2);
  for (size_t i = 0; i < width; ++i) below.push_back(writer.add_brick(1 + 3 * i));
  for (int level = levels - 3; level >= 0; --level) {
    writer.begin_level(level);
    std::vector<NodeKey> keys(level == 0 ? 1 : width);
    for (NodeKey& key : keys) {
      for (uint32_t& child : key)
        child = random() % 3 == 0 ? 0 : 1 + below[random() % below.size()];
      key[7] = 1 + below[0];
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    below.clear();
    for (const NodeKey& key : keys) below.push_back(writer.add_node(key));
  }
  writer.finish(42, 0.25);
  return read_bytes(path);
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), std::streamsize(bytes.size()));
}

bool is_sound(const std::string& path) {
  try {
    check_dag(File::open_read(path));
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
    return false;
  }
}

TEST(CheckDag, FindsEveryFlippedBit) {
  const TempFolder folder;
  const std::string path = folder.file("a.svdag");
  std::string bytes = make_file(path);
  ASSERT_GE(bytes.size(), 16384U);
  ASSERT_TRUE(is_sound(path));
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  size_t missed = 0;
  for (size_t i = 0; i < bytes.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      file.seekp(std::streamoff(i)).put(char(bytes[i] ^ (1 << bit))).flush();
      missed += is_sound(path);
    }
    file.seekp(std::streamoff(i)).put(bytes[i]).flush();
  }
  EXPECT_EQ(missed, 0U) << "of " << 8 * bytes.size();
  EXPECT_TRUE(is_sound(path));
}

TEST(CheckDag, FindsEveryTruncationAndEveryAppendedLength) {
  const TempFolder folder;
  const std::string path = folder.file("a.svdag");
  const std::string bytes = make_file(path, 4, 20);
  for (size_t length = 0; length < bytes.size(); ++length) {
    write_bytes(path, bytes.substr(0, length));
    EXPECT_FALSE(is_sound(path)) << length;
  }
  for (size_t more = 1; more < 200; ++more) {
    write_bytes(path, bytes + std::string(more, '\0'));
    EXPECT_FALSE(is_sound(path)) << more;
  }
}

// Changes one word and recomputes all checksums, as an attacker would.
void forge(std::string bytes, const std::string& path, size_t offset, uint32_t word) {
  std::memcpy(bytes.data() + offset, &word, 4);
  repair_checksums(&bytes);
  write_bytes(path, bytes);
}

TEST(CheckDag, NeverFollowsAForgedFieldOutOfTheFile) {
  const TempFolder folder;
  const std::string path = folder.file("a.svdag");
  const std::string bytes = make_file(path, 5, 30);
  Header h;
  std::memcpy(&h, bytes.data(), sizeof h);
  size_t accepted = 0;
  const auto try_word = [&](size_t offset, uint32_t word) {
    forge(bytes, path, offset, word);
    if (!is_sound(path)) return;
    ++accepted;
    // An accepted file can be walked; the sanitizers detect invalid accesses.
    const DagFile file = DagFile::open(path);
    for (uint32_t x = 0; x < file.view().resolution() / 4; ++x) dag_brick(file.view(), x, x, x / 2);
  };
  for (size_t offset = 8; offset < sizeof(Header) - 8; offset += 4) {
    for (const uint32_t word : {0U, 1U, 0x7fffffffU, 0x80000000U, 0xffffffffU})
      try_word(offset, word);
  }
  for (size_t offset = sizeof(Header); offset + 4 <= h.metadata_offset; offset += 4) {
    for (const uint32_t word : {0U, 0xffU, 0x100U, 3U, 0x80000000U, 0xffffffffU})
      try_word(offset, word);
  }
  EXPECT_GT(accepted, 0U);  // some changes give another valid file
}

// The child masks above an empty brick contradict it, and coarser levels are read from those masks.
TEST(CheckDag, RejectsTransformsThatNoBakeStores) {
  const TempFolder folder;
  const std::string path = folder.file("a.svdag");
  const std::string bytes = make_file(path, 5, 30);
  using Rows = std::array<double, 12>;
  const auto is_accepted = [&](const Rows& rows) {
    std::string changed = bytes;
    std::memcpy(changed.data() + offsetof(Header, transform), rows.data(), sizeof rows);
    repair_checksums(&changed);
    write_bytes(path, changed);
    return is_sound(path);
  };
  EXPECT_TRUE(is_accepted({}));
  EXPECT_TRUE(is_accepted({2, 0, 0, 5, 0, 2, 0, 0, 0, 0, 2, 0}));
  EXPECT_FALSE(is_accepted({-0.0}));
  EXPECT_FALSE(is_accepted({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
  EXPECT_FALSE(is_accepted({1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0}));
  EXPECT_FALSE(is_accepted({1, 0, 0, NAN, 0, 1, 0, 0, 0, 0, 1, 0}));
  EXPECT_FALSE(is_accepted({INFINITY, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
}

TEST(CheckDag, RejectsAnEmptyBrick) {
  const TempFolder folder;
  const std::string path = folder.file("a.svdag");
  std::string bytes = make_file(path, 5, 30);
  Header h;
  std::memcpy(&h, bytes.data(), sizeof h);
  for (const uint64_t brick : {uint64_t(0), h.sections[3].nodes - 1}) {
    std::string emptied = bytes;
    std::memset(emptied.data() + h.sections[3].offset + 8 * brick, 0, 8);
    repair_checksums(&emptied);
    write_bytes(path, emptied);
    EXPECT_SVDAG_ERROR(check_dag(File::open_read(path)), ExitCode::kBadInput, "an empty brick");
  }
}

TEST(CheckDag, ReportsOtherFormatsAndVersions) {
  const TempFolder folder;
  const std::string path = folder.file("a.svdag");
  write_bytes(path, std::string(5000, 'x'));
  try {
    check_dag(File::open_read(path));
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(
        error.what(),
        (path + ": is not a .svdag (its first bytes are not \\x89SVDAG): svdag build makes "
                "one of a scene")
            .c_str());
  }
  std::string newer = make_file(path, 4, 10);
  newer[8] = kMaxVersion + 1;
  write_bytes(path, newer);
  try {
    check_dag(File::open_read(path));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("has format version 4"), std::string::npos);
  }
}

}  // namespace
}  // namespace svdag
