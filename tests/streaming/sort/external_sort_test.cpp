#include "streaming/sort/external_sort.h"

#include <gtest/gtest.h>

#include <chrono>
#include <exception>
#include <random>
#include <thread>

#include "streaming/file/file_folder.h"
#include "streaming/process/interrupt.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

using Key = std::array<uint32_t, 8>;

enum class KeyOrder { kRandom, kFew, kEqual, kAscending, kDescending };

std::vector<Key> make_keys(KeyOrder order, size_t count, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Key> keys(count);
  for (size_t i = 0; i < count; ++i) {
    const uint32_t number = uint32_t(order == KeyOrder::kDescending ? count - i : i);
    keys[i] = {0, 0, 7, 0, number, 0, 0, 1};
    if (order == KeyOrder::kEqual) keys[i][4] = 5;
    if (order != KeyOrder::kRandom && order != KeyOrder::kFew) continue;
    const uint32_t range = order == KeyOrder::kRandom ? 1 << 22 : 2;
    for (uint32_t& word : keys[i]) word = random() % 100 < 55 ? uint32_t(random() % range) : 0;
  }
  return keys;
}

struct Sorter {
  Sorter(uint64_t bytes, size_t threads, uint64_t limit = MemoryBudget::kUnlimited)
      : budget(limit),
        executor(threads),
        sort({&budget, bytes, &executor, [this] { return folder.create("spill"); }}, 8,
             [](const Key& k, size_t i) { return k[i]; }) {}
  std::vector<Key> finish() {
    std::vector<Key> sorted;
    sort.finish(
        [&](std::span<const Key> keys) { sorted.insert(sorted.end(), keys.begin(), keys.end()); });
    return sorted;
  }

  TempFolder temp;
  Folder folder = Folder::open_private(temp.path());
  MemoryBudget budget;
  ParallelExecutor executor;
  ExternalSort<Key, uint32_t (*)(const Key&, size_t)> sort;
};

void expect_sorted_like_std_sort(std::vector<Key> keys, uint64_t bytes, size_t threads) {
  Sorter sorter(bytes, threads);
  for (const Key& key : keys) sorter.sort.push(key);
  const std::vector<Key> sorted = sorter.finish();
  std::sort(keys.begin(), keys.end());
  EXPECT_TRUE(sorted == keys) << keys.size() << " keys, " << bytes << " bytes, " << threads;
  EXPECT_LE(sorter.sort.peak_bytes(), bytes);
}

TEST(ExternalSort, SortsLikeStdSort) {
  std::mt19937_64 random(1);
  for (const KeyOrder order : {KeyOrder::kRandom, KeyOrder::kFew, KeyOrder::kEqual,
                               KeyOrder::kAscending, KeyOrder::kDescending}) {
    for (const size_t count : {0, 1, 2, 1000, 70000, 200000}) {
      for (const size_t threads : {1, 2, 5}) {
        const uint64_t min_bytes = threads * ExternalSortConfig::kMinBytesPerWorker;
        const size_t size = count < 10 ? count : count + random() % count;
        expect_sorted_like_std_sort(make_keys(order, size, random()),
                                    min_bytes + random() % min_bytes, threads);
      }
    }
  }
}

TEST(ExternalSort, MergesManyStreamsInGroups) {
  Sorter sorter(ExternalSortConfig::kMinBytesPerWorker, 1);
  std::vector<Key> keys = make_keys(KeyOrder::kRandom, 600000, 3);
  for (const Key& key : keys) sorter.sort.push(key);
  std::sort(keys.begin(), keys.end());
  EXPECT_TRUE(sorter.finish() == keys);
  EXPECT_GT(sorter.sort.read_bytes(), keys.size() * sizeof(Key) * 3 / 2);
  EXPECT_LE(sorter.sort.peak_bytes(), ExternalSortConfig::kMinBytesPerWorker);
}

TEST(ExternalSort, InputThatFitsIsNotSpilled) {
  Sorter sorter(64 << 20, 2);
  for (const Key& key : make_keys(KeyOrder::kRandom, 900000, 4)) sorter.sort.push(key);
  EXPECT_EQ(sorter.finish().size(), 900000U);
  EXPECT_EQ(sorter.sort.written_bytes(), 0U);
  EXPECT_EQ(sorter.temp.entries(), 0U);
}

TEST(ExternalSort, WritesAndReadsEachRecordOnce) {
  Sorter sorter(8 << 20, 2);
  const size_t count = 2000000;
  for (const Key& key : make_keys(KeyOrder::kRandom, count, 5)) sorter.sort.push(key);
  EXPECT_EQ(sorter.finish().size(), count);
  EXPECT_LT(sorter.sort.written_bytes(), count * sizeof(Key) * 11 / 10);
  EXPECT_EQ(sorter.sort.read_bytes(), sorter.sort.written_bytes());
}

TEST(ExternalSort, ReservesAndReleasesItsMemory) {
  MemoryBudget budget(4 << 20);
  ParallelExecutor executor(2);
  const auto word = [](const Key& k, size_t i) { return k[i]; };
  {
    ExternalSort<Key, decltype(word)> sort({&budget, 3 << 20, &executor, {}}, 8, word);
    EXPECT_EQ(budget.used(), uint64_t(3) << 20);
  }
  EXPECT_EQ(budget.used(), 0U);
  const auto too_large = [&] {
    ExternalSort<Key, decltype(word)> sort({&budget, 5 << 20, &executor, {}}, 8, word);
  };
  EXPECT_SVDAG_ERROR(too_large(), ExitCode::kMemory, "raise --memory");
}

// No worker may wait for the turn of a failed one.
TEST(ExternalSort, AnErrorOfTheSinkEndsTheSort) {
  for (const size_t count : {100000, 1000000}) {
    Sorter sorter(8 << 20, 3);
    for (const Key& key : make_keys(KeyOrder::kRandom, count, 6)) sorter.sort.push(key);
    size_t calls = 0;
    const auto fail_soon = [&](std::span<const Key>) {
      if (++calls == 3) throw Error(ExitCode::kOutput, "full");
    };
    EXPECT_SVDAG_ERROR(sorter.sort.finish(fail_soon), ExitCode::kOutput, "full");
  }
}

// Runs all tasks one after the other, even after a failed one, as if they had started before it.
class RunAllExecutor : public Executor {
 public:
  explicit RunAllExecutor(size_t workers) : workers_(workers) {}
  size_t workers() const override { return workers_; }
  void for_each(size_t count, const Task& task) override {
    std::exception_ptr first;
    for (size_t i = 0; i < count; ++i) {
      try {
        task(i % workers_, i);
      } catch (...) {
        if (!first) first = std::current_exception();
      }
    }
    if (first) std::rethrow_exception(first);
  }

 private:
  size_t workers_;
};

struct RunAllSorter {
  RunAllSorter(uint64_t bytes, size_t workers)
      : executor(workers),
        sort({&budget, bytes, &executor, [this] { return folder.create("spill"); }}, 8,
             [](const Key& k, size_t i) { return k[i]; }) {}

  TempFolder temp;
  Folder folder = Folder::open_private(temp.path());
  MemoryBudget budget;
  RunAllExecutor executor;
  ExternalSort<Key, uint32_t (*)(const Key&, size_t)> sort;
};

// The worker after the failed one finds fewer blocks than its piece needs.
TEST(ExternalSort, ADamagedBlockAlsoEndsWorkersThatHaveStarted) {
  RunAllSorter sorter(3 * ExternalSortConfig::kMinBytesPerWorker, 3);
  for (const Key& key : make_keys(KeyOrder::kRandom, 100000, 9)) sorter.sort.push(key);
  File spilled = sorter.folder.open("spill");
  std::byte first;  // payload byte of the first block, which has the smallest keys of its stream
  spilled.read_at(kSpillHeader, {&first, 1});
  first ^= std::byte(1);
  spilled.write_at(kSpillHeader, {&first, 1});
  size_t received = 0;
  const auto count = [&](std::span<const Key> keys) { received += keys.size(); };
  EXPECT_SVDAG_ERROR(sorter.sort.finish(count), ExitCode::kOutput, "scratch file is damaged");
  EXPECT_EQ(received, 0U);
}

TEST(ExternalSort, WorksWithHundredsOfWorkers) {
  for (const size_t workers : {255, 256, 512}) {
    RunAllSorter sorter(workers * ExternalSortConfig::kMinBytesPerWorker, workers);
    std::vector<Key> keys = make_keys(KeyOrder::kRandom, 20000, 10), sorted;
    for (const Key& key : keys) sorter.sort.push(key);
    sorter.sort.finish(
        [&](std::span<const Key> some) { sorted.insert(sorted.end(), some.begin(), some.end()); });
    std::sort(keys.begin(), keys.end());
    EXPECT_TRUE(sorted == keys) << workers;
    EXPECT_LE(sorter.sort.peak_bytes(), workers * ExternalSortConfig::kMinBytesPerWorker);
  }
}

TEST(ParallelMerge, APieceHasAtLeastOneBlock) {
  using Merge = ParallelMerge<Key, uint32_t (*)(const Key&, size_t)>;
  EXPECT_EQ(Merge::step(510, 2, 256), 1U);
  EXPECT_EQ(Merge::step(510, 2, 1), (510U - 4) / 3);
}

// No worker may wait for the turn of one that an interrupt stopped before its start.
TEST(ExternalSort, AnInterruptEndsTheSort) {
  std::atomic<bool> finishing{false};
  ParallelExecutor executor(2, [&](size_t index) {
    if (!finishing || index != 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // others wait for this one
    pretend_interrupt(2);
  });
  TempFolder temp;
  const Folder folder = Folder::open_private(temp.path());
  MemoryBudget budget;
  ExternalSort<Key, uint32_t (*)(const Key&, size_t)> sort(
      {&budget, 8 << 20, &executor, [&] { return folder.create("spill"); }}, 8,
      [](const Key& k, size_t i) { return k[i]; });
  for (const Key& key : make_keys(KeyOrder::kRandom, 10000, 8)) sort.push(key);
  finishing = true;
  EXPECT_THROW(sort.finish([](std::span<const Key>) {}), Interrupted);
  pretend_interrupt(0);
}

}  // namespace
}  // namespace svdag
