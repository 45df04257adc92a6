#include "streaming/process/executor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace svdag {
namespace {

// Shuffles the schedule reproducibly: the delay depends only on the index.
void delay(size_t index) {
  std::this_thread::sleep_for(std::chrono::microseconds(index * 7919 % 200));
}

void expect_every_index_once(Executor& executor, size_t count) {
  std::vector<std::atomic<int>> runs(count);
  executor.for_each(count, [&](size_t worker, size_t index) {
    EXPECT_LT(worker, executor.workers());
    ++runs[index];
  });
  for (size_t i = 0; i < count; ++i) EXPECT_EQ(runs[i], 1) << i;
}

TEST(Executor, EveryIndexRunsExactlyOnce) {
  SequentialExecutor sequential;
  expect_every_index_once(sequential, 100);
  for (const size_t threads : {1, 2, 5}) {
    ParallelExecutor parallel(threads), delayed(threads, delay);
    for (const size_t count : {0, 1, 3, 500}) {
      expect_every_index_once(parallel, count);
      expect_every_index_once(delayed, count);
    }
  }
}

TEST(Executor, AWorkerIsOneThreadAtATime) {
  ParallelExecutor executor(4, delay);
  std::vector<std::atomic<int>> busy(executor.workers());
  executor.for_each(400, [&](size_t worker, size_t) {
    EXPECT_EQ(busy[worker]++, 0);
    std::this_thread::yield();
    --busy[worker];
  });
}

TEST(Executor, LowIndicesStartFirst) {
  std::vector<size_t> order;
  SequentialExecutor().for_each(5, [&](size_t, size_t i) { order.push_back(i); });
  EXPECT_EQ(order, (std::vector<size_t>{0, 1, 2, 3, 4}));
  // With w workers an index starts when all but w - 1 of those before it have started.
  ParallelExecutor executor(3, delay);
  std::atomic<size_t> started{0};
  executor.for_each(300, [&](size_t, size_t i) { EXPECT_GE(++started + 2, i + 1); });
}

TEST(Executor, ForEachReturnsAfterTheLastTask) {
  ParallelExecutor executor(4, delay);
  std::atomic<int> done{0};
  executor.for_each(50, [&](size_t, size_t index) {
    delay(index);
    ++done;
  });
  EXPECT_EQ(done, 50);
}

TEST(Executor, TheFirstExceptionStopsTheRestAndIsThrown) {
  for (const size_t threads : {1, 4}) {
    ParallelExecutor executor(threads);
    std::atomic<size_t> runs{0};
    const auto task = [&](size_t, size_t index) {
      ++runs;
      std::this_thread::sleep_for(std::chrono::microseconds(50));
      if (index == 3) throw std::runtime_error("task 3");
    };
    try {
      executor.for_each(100'000, task);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "task 3");
    }
    EXPECT_LT(runs, 10'000U);
  }
}

TEST(Executor, IsUsableAgainAfterAnException) {
  ParallelExecutor executor(3);
  EXPECT_THROW(executor.for_each(10, [](size_t, size_t) { throw 1; }), int);
  expect_every_index_once(executor, 20);
}

TEST(Executor, AtLeastOneProcessorAndOneWorker) {
  EXPECT_GE(available_processors(), 1U);
  EXPECT_EQ(ParallelExecutor(0).workers(), 1U);
}

}  // namespace
}  // namespace svdag
