#include "streaming/memory/memory_budget.h"

#include <atomic>
#include <thread>
#include <vector>

#include "tests/expect_error.h"

namespace svdag {
namespace {

constexpr uint64_t kMiB = uint64_t(1) << 20;

TEST(MemoryBudget, TheDestructorReleasesAReservation) {
  MemoryBudget budget(100);
  {
    const auto a = budget.reserve(60, "nodes");
    EXPECT_EQ(budget.used(), 60U);
    const auto b = budget.reserve(40, "nodes");
    EXPECT_EQ(budget.used(), 100U);
  }
  EXPECT_EQ(budget.used(), 0U);
  EXPECT_EQ(budget.peak(), 100U);
}

TEST(MemoryBudget, OneByteMoreThanTheLimitIsAnError) {
  MemoryBudget budget(10 * kMiB);
  EXPECT_NO_THROW(budget.reserve(10 * kMiB, "nodes"));
  EXPECT_SVDAG_ERROR(
      budget.reserve(10 * kMiB + 1, "nodes"), ExitCode::kMemory,
      "the nodes need 11 MiB in total, but the memory budget is 10 MiB: raise --memory");
  EXPECT_EQ(budget.used(), 0U);
}

TEST(MemoryBudget, AFailedReservationChangesNeitherUseNorPeak) {
  MemoryBudget budget(100);
  const auto held = budget.reserve(50, "nodes");
  EXPECT_THROW(budget.reserve(51, "nodes"), Error);
  EXPECT_THROW(budget.reserve(UINT64_MAX, "nodes"), Error);  // the sum overflows
  EXPECT_EQ(budget.used(), 50U);
  EXPECT_EQ(budget.peak(), 50U);
}

TEST(MemoryBudget, AFailedTryResizeChangesNothing) {
  MemoryBudget budget(100);
  auto held = budget.reserve(50, "nodes");
  EXPECT_FALSE(held.try_resize(101));
  EXPECT_EQ(held.bytes(), 50U);
  EXPECT_EQ(budget.used(), 50U);
  EXPECT_TRUE(held.try_resize(100));
  EXPECT_TRUE(held.try_resize(20));
  EXPECT_EQ(budget.used(), 20U);
  EXPECT_EQ(budget.peak(), 100U);
}

TEST(MemoryBudget, TheLapPeakStartsAtTheCurrentUse) {
  MemoryBudget budget(100);
  const auto held = budget.reserve(20, "nodes");
  { const auto passing = budget.reserve(70, "nodes"); }
  EXPECT_EQ(budget.lap_peak(), 90U);
  EXPECT_EQ(budget.lap_peak(), 20U);
  { const auto passing = budget.reserve(10, "nodes"); }
  EXPECT_EQ(budget.lap_peak(), 30U);
  EXPECT_EQ(budget.peak(), 90U);
}

TEST(MemoryBudget, AFailedResizeKeepsTheOldSize) {
  MemoryBudget budget(100);
  auto held = budget.reserve(10, "nodes");
  held.resize(90, "nodes");
  EXPECT_EQ(budget.used(), 90U);
  EXPECT_THROW(held.resize(101, "nodes"), Error);
  EXPECT_EQ(held.bytes(), 90U);
  held.resize(5, "nodes");
  EXPECT_EQ(budget.used(), 5U);
}

TEST(MemoryBudget, MovingAReservationCountsItOnce) {
  MemoryBudget budget(100);
  auto a = budget.reserve(30, "nodes");
  auto b = std::move(a);
  a.release();  // NOLINT(bugprone-use-after-move): moved-from is empty
  EXPECT_EQ(budget.used(), 30U);
  auto c = budget.reserve(20, "nodes");
  c = std::move(b);
  EXPECT_EQ(budget.used(), 30U);
  c.release();
  c.release();
  EXPECT_EQ(budget.used(), 0U);
}

TEST(MemoryBudget, ThreadsTogetherNeverExceedTheLimit) {
  MemoryBudget budget(64);
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 20'000; ++i) {
          try {
            const auto held = budget.reserve(uint64_t(i % 40), "nodes");
          } catch (const Error&) {
          }
        }
      });
    }
  }
  EXPECT_EQ(budget.used(), 0U);
  EXPECT_LE(budget.peak(), 64U);
  EXPECT_GE(budget.peak(), 39U);
}

TEST(MemoryBudget, ARejectedRequestDoesNotFailAnotherOne) {
  MemoryBudget budget(100);
  std::atomic<bool> tries{false};
  const std::jthread greedy([&](const std::stop_token& stop) {
    MemoryBudget::Reservation held(&budget, 0);
    for (; !stop.stop_requested(); tries = true) EXPECT_FALSE(held.try_resize(101));
  });
  while (!tries) std::this_thread::yield();
  for (int i = 0; i < 1'000'000; ++i) ASSERT_NO_THROW(budget.reserve(100, "nodes"));
  EXPECT_EQ(budget.peak(), 100U);
}

TEST(MemoryBudget, TheMachineHasMemory) {
  EXPECT_GT(default_memory_limit(), 32 * kMiB);
  EXPECT_GT(peak_resident_bytes(), kMiB);
}

}  // namespace
}  // namespace svdag
