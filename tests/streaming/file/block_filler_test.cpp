// Blocks hold the appended bytes in order, whatever the sizes of the appends, and have their
// checksums in the order of the blocks, whatever the order they are written in.
#include "streaming/file/block_filler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

namespace svdag {
namespace {

constexpr size_t kSize = 64, kMargin = 8;

TEST(BlockFiller, CutsBytesIntoBlocksWithAMargin) {
  std::mt19937 random(1);
  std::vector<std::byte> sent;
  std::map<uint64_t, std::vector<std::byte>> written;
  BlockFiller filler(kSize, kMargin);
  std::vector<FilledBlocks> callers(3);
  const auto write = [&](FilledBlock& block) {
    const auto payload = block.bytes().subspan(kMargin);
    EXPECT_TRUE(written.emplace(block.number, std::vector(payload.begin(), payload.end())).second);
    return 1000 + block.number;
  };
  for (int i = 0; i < 500; ++i) {
    std::vector<std::byte> bytes(random() % 200);
    for (std::byte& byte : bytes) byte = std::byte(random());
    sent.insert(sent.end(), bytes.begin(), bytes.end());
    filler.append(bytes, &callers[random() % 3]);
    EXPECT_EQ(filler.position(), sent.size());
    if (random() % 3 == 0) callers[random() % 3].write_all(write);
  }
  filler.finish(&callers[0]);
  for (FilledBlocks& caller : callers) caller.write_all(write);
  std::vector<std::byte> received;
  for (const auto& [number, payload] : written) {
    if (number + 1 < written.size()) {
      EXPECT_EQ(payload.size(), kSize - kMargin);
    }
    received.insert(received.end(), payload.begin(), payload.end());
  }
  EXPECT_EQ(received, sent);
  std::vector<uint64_t> expected(written.size());
  std::iota(expected.begin(), expected.end(), 1000U);
  EXPECT_TRUE(std::ranges::equal(filler.checksums(), expected));
}

TEST(BlockFiller, WithoutBytesThereIsNoBlock) {
  BlockFiller filler(kSize, kMargin);
  FilledBlocks filled;
  filler.append({}, &filled);
  filler.finish(&filled);
  EXPECT_TRUE(filled.blocks.empty());
}

}  // namespace
}  // namespace svdag
