#include "streaming/spill/spill_block.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

namespace svdag {
namespace {

std::vector<std::byte> sealed(const SpillLabel& label, size_t size = 4096) {
  std::mt19937_64 random(label.index);
  std::vector<std::byte> block(size);
  for (std::byte& byte : block) byte = std::byte(random());
  seal_block(block, label);
  return block;
}

bool opens(std::vector<std::byte> block, const SpillLabel& label) {
  return open_block(block, label);
}

TEST(SpillBlock, HasTheLayoutDocumentedInSpillFile) {
  const auto block = sealed({0x1122334455667788, 3, 100});
  const auto number = [&](size_t at, size_t size) {
    uint64_t value = 0;
    std::memcpy(&value, block.data() + at, size);
    return value;
  };
  EXPECT_EQ(std::memcmp(block.data(), "SVSP", 4), 0);
  EXPECT_EQ(number(4, 4), 100U);
  EXPECT_EQ(number(8, 8), 0x1122334455667788U);
  EXPECT_EQ(number(16, 8), 3U);
  for (size_t i = 32; i < 64; ++i) EXPECT_EQ(block[i], std::byte(0));
  for (size_t i = 64 + 100; i < 4096; ++i) EXPECT_EQ(block[i], std::byte(0));
}

TEST(SpillBlock, EveryFlippedBitIsDetected) {
  for (const SpillLabel label : {SpillLabel{0, 0, 4032}, SpillLabel{7, 1, 4031},
                                 SpillLabel{UINT64_MAX, 2, 1}, SpillLabel{1, UINT64_MAX, 0}}) {
    auto block = sealed(label);
    ASSERT_TRUE(opens(block, label));
    for (size_t bit = 0; bit < block.size() * 8; ++bit) {
      const std::byte mask = std::byte(1 << bit % 8);
      block[bit / 8] ^= mask;
      ASSERT_FALSE(opens(block, label)) << bit;
      block[bit / 8] ^= mask;
    }
  }
}

TEST(SpillBlock, OpensForItsOwnLabelOnly) {
  const auto block = sealed({5, 6, 7});
  EXPECT_TRUE(opens(block, {5, 6, 7}));
  EXPECT_FALSE(opens(block, {4, 6, 7}));
  EXPECT_FALSE(opens(block, {5, 7, 7}));
  EXPECT_FALSE(opens(block, {5, 6, 8}));
  EXPECT_FALSE(opens(std::vector<std::byte>(4096), {0, 0, 0}));  // a hole in the file
}

TEST(SpillBlock, ItsMemoryIsAlignedAndReserved) {
  MemoryBudget budget(10'000);
  {
    const SpillBlock block(&budget, 8192);
    EXPECT_EQ(uintptr_t(block.bytes().data()) % SpillBlock::kAlignment, 0U);
    EXPECT_EQ(block.bytes().size(), 8192U);
    EXPECT_EQ(budget.used(), 8192U);
  }
  EXPECT_EQ(budget.used(), 0U);
  EXPECT_FALSE(SpillBlock());
}

}  // namespace
}  // namespace svdag
