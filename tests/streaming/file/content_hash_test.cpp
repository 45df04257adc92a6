// Reads in any order and of any size give the hash of the whole, once their gaps are filled.
#include "streaming/file/content_hash.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "streaming/file/file.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

Hash128 digest_of(std::span<const std::byte> bytes) {
  Hasher128 hasher;
  hasher.update(bytes);
  return hasher.digest();
}

TEST(ContentHash, TakesWhatContinuesAndNothingTwice) {
  std::mt19937_64 random(1);
  std::string text(5000, ' ');
  for (char& c : text) c = char(random());
  const TempFolder folder;
  std::ofstream(folder.file("a"), std::ios::binary) << text;
  const auto bytes = std::as_bytes(std::span(text));
  for (int round = 0; round < 200; ++round) {
    ContentHash hash;
    File file = File::open_read(folder.file("a"));
    file.hash_reads(&hash);
    const File moved = std::move(file);
    std::vector<std::byte> out(1000);
    for (int reads = int(random() % 40); reads > 0; --reads)
      moved.read_some_at(random() % 6000, std::span(out).first(random() % 1000));
    const uint64_t size = hash.size();
    ASSERT_LE(size, bytes.size());
    EXPECT_EQ(hash.digest(), digest_of(bytes.first(size)));
    moved.read_some_at(0, std::span(out).first(std::min<size_t>(size, 1000)));
    EXPECT_EQ(hash.size(), size);
    hash.add(0, bytes);
    EXPECT_EQ(hash.size(), bytes.size());
    EXPECT_EQ(hash.digest(), digest_of(bytes));
  }
}

}  // namespace
}  // namespace svdag
