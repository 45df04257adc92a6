#include "streaming/memory/segmented_array.h"

#include <gtest/gtest.h>

#include "streaming/memory/huge_vector.h"

namespace svdag {
namespace {

TEST(SegmentedArray, GrowsWithoutMovingElements) {
  MemoryBudget budget;
  SegmentedArray<uint64_t> array(&budget, "test");
  std::vector<const uint64_t*> addresses;
  constexpr size_t kCount = 3'000'000;
  for (size_t i = 0; i < kCount; ++i) {
    array.push_back(i * i);
    if (i % 1000 == 0) addresses.push_back(&array[i]);
  }
  ASSERT_EQ(array.size(), kCount);
  for (size_t i = 0; i < kCount; ++i) ASSERT_EQ(array[i], i * i);
  for (size_t i = 0; i < kCount; i += 1000) EXPECT_EQ(&array[i], addresses[i / 1000]);
}

TEST(SegmentedArray, ReservesAndReleasesItsMemory) {
  MemoryBudget budget;
  SegmentedArray<uint64_t> array(&budget, "test");
  for (size_t i = 0; i < 1'000'000; ++i) array.push_back(i);
  EXPECT_GE(budget.used(), 8'000'000U);
  EXPECT_LE(budget.used(), 10'000'000U);
  array.clear();
  EXPECT_EQ(budget.used(), 0U);
  EXPECT_EQ(array.size(), 0U);
}

TEST(SegmentedArray, CannotExceedTheBudget) {
  MemoryBudget budget(1 << 20);
  SegmentedArray<uint64_t> array(&budget, "test");
  EXPECT_THROW(for (size_t i = 0; i < 1'000'000; ++i) array.push_back(i), Error);
}

TEST(HugeVector, WorksAboveAndBelowTheSizeOfAHugePage) {
  for (const size_t count : {0, 1, 1000, 700'000, 3'000'000}) {
    HugeVector<uint64_t> v(count);
    for (size_t i = 0; i < count; ++i) v[i] = ~i;
    HugeVector<uint64_t> copy = v;
    copy.resize(count + 10);
    for (size_t i = 0; i < count; ++i) ASSERT_EQ(copy[i], ~i);
    const bool large = count * sizeof(uint64_t) >= size_t(1) << 22;
    EXPECT_TRUE(!large || reinterpret_cast<uintptr_t>(v.data()) % (size_t(1) << 21) == 0);
  }
}

TEST(HugePages, AreZero) {
  for (const size_t bytes : {size_t(100), size_t(10) << 20}) {
    const HugePages pages(bytes);
    const char* data = static_cast<const char*>(pages.data());
    for (size_t i = 0; i < bytes; ++i) ASSERT_EQ(data[i], 0);
  }
}

TEST(HugePages, GrowWithTheirContent) {
  HugePages pages;
  size_t filled = 0;
  for (const size_t bytes : {size_t(100), size_t(1) << 22, size_t(10) << 20, size_t(30) << 20}) {
    pages.grow(bytes);
    ASSERT_EQ(pages.bytes(), bytes);
    char* data = static_cast<char*>(pages.data());
    for (size_t i = 0; i < bytes; ++i) ASSERT_EQ(data[i], i < filled ? char(i % 101) : 0);
    for (; filled < bytes; ++filled) data[filled] = char(filled % 101);
  }
}

}  // namespace
}  // namespace svdag
