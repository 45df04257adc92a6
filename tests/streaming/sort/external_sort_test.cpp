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

enum class Kind { kRandom, kFew, kEqual, kAscending, kDescending };

std::vector<Key> make_keys(Kind kind, size_t count, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Key> keys(count);
  for (size_t i = 0; i < count; ++i) {
    const uint32_t number = uint32_t(kind == Kind::kDescending ? count - i : i);
    keys[i] = {0, 0, 7, 0, number, 0, 0, 1};
    if (kind == Kind::kEqual) keys[i][4] = 5;
    if (kind != Kind::kRandom && kind != Kind::kFew) continue;
    const uint32_t range = kind == Kind::kRandom ? 1 << 22 : 2;
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

TEST(ExternalSort, GivesWhatStdSortGives) {
  std::mt19937_64 random(1);
  for (const Kind kind :
       {Kind::kRandom, Kind::kFew, Kind::kEqual, Kind::kAscending, Kind::kDescending}) {
    for (const size_t count : {0, 1, 2, 1000, 70000, 200000}) {
      for (const size_t threads : {1, 2, 5}) {
        const uint64_t least = threads * ExternalSortRoom::kLeast;
        const size_t size = count < 10 ? count : count + random() % count;
        expect_sorted_like_std_sort(make_keys(kind, size, random()), least + random() % least,
                                    threads);
      }
    }
  }
}

TEST(ExternalSort, MergesInGroupsWhereRunsAreMany) {
  Sorter sorter(ExternalSortRoom::kLeast, 1);
  std::vector<Key> keys = make_keys(Kind::kRandom, 600000, 3);
  for (const Key& key : keys) sorter.sort.push(key);
  std::sort(keys.begin(), keys.end());
  EXPECT_TRUE(sorter.finish() == keys);
  EXPECT_GT(sorter.sort.read_bytes(), keys.size() * sizeof(Key) * 3 / 2);
  EXPECT_LE(sorter.sort.peak_bytes(), ExternalSortRoom::kLeast);
}

TEST(ExternalSort, WhatFitsIsNotSpilled) {
  Sorter sorter(64 << 20, 2);
  for (const Key& key : make_keys(Kind::kRandom, 900000, 4)) sorter.sort.push(key);
  EXPECT_EQ(sorter.finish().size(), 900000U);
  EXPECT_EQ(sorter.sort.written_bytes(), 0U);
  EXPECT_EQ(sorter.temp.entries(), 0U);
}

TEST(ExternalSort, WritesAndReadsEachRecordOnce) {
  Sorter sorter(8 << 20, 2);
  const size_t count = 2000000;
  for (const Key& key : make_keys(Kind::kRandom, count, 5)) sorter.sort.push(key);
  EXPECT_EQ(sorter.finish().size(), count);
  EXPECT_LT(sorter.sort.written_bytes(), count * sizeof(Key) * 11 / 10);
  EXPECT_EQ(sorter.sort.read_bytes(), sorter.sort.written_bytes());
}

TEST(ExternalSort, TakesItsMemoryFromTheBudgetAndGivesItBack) {
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
  EXPECT_SVDAG_ERROR(too_large(), ExitCode::kMemory, "give more with --memory");
}

// No worker waits for the turn of one that has failed.
TEST(ExternalSort, AnErrorOfTheTakerEndsTheSort) {
  for (const size_t count : {100000, 1000000}) {
    Sorter sorter(8 << 20, 3);
    for (const Key& key : make_keys(Kind::kRandom, count, 6)) sorter.sort.push(key);
    size_t calls = 0;
    const auto fail_soon = [&](std::span<const Key>) {
      if (++calls == 3) throw Error(ExitCode::kOutput, "full");
    };
    EXPECT_SVDAG_ERROR(sorter.sort.finish(fail_soon), ExitCode::kOutput, "full");
  }
}

// One task after the other, and all of them, as if those after a failed one had begun before it.
class StubbornExecutor : public Executor {
 public:
  explicit StubbornExecutor(size_t workers) : workers_(workers) {}
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

struct StubbornSorter {
  StubbornSorter(uint64_t bytes, size_t workers)
      : executor(workers),
        sort({&budget, bytes, &executor, [this] { return folder.create("spill"); }}, 8,
             [](const Key& k, size_t i) { return k[i]; }) {}

  TempFolder temp;
  Folder folder = Folder::open_private(temp.path());
  MemoryBudget budget;
  StubbornExecutor executor;
  ExternalSort<Key, uint32_t (*)(const Key&, size_t)> sort;
};

// Who comes after it finds fewer blocks than the pieces need.
TEST(ExternalSort, ADamagedBlockEndsTheSortForWorkersThatHaveBegunToo) {
  StubbornSorter sorter(3 * ExternalSortRoom::kLeast, 3);
  for (const Key& key : make_keys(Kind::kRandom, 100000, 9)) sorter.sort.push(key);
  File spilled = sorter.folder.open("spill");
  std::byte first;  // of the first block, behind its header: it holds the least keys of its run
  spilled.read_at(kSpillHeader, {&first, 1});
  first ^= std::byte(1);
  spilled.write_at(kSpillHeader, {&first, 1});
  size_t taken = 0;
  const auto count = [&](std::span<const Key> keys) { taken += keys.size(); };
  EXPECT_SVDAG_ERROR(sorter.sort.finish(count), ExitCode::kOutput, "scratch file is damaged");
  EXPECT_EQ(taken, 0U);
}

TEST(ExternalSort, HundredsOfWorkersHaveSmallerBlocks) {
  for (const size_t workers : {255, 256, 512}) {
    StubbornSorter sorter(workers * ExternalSortRoom::kLeast, workers);
    std::vector<Key> keys = make_keys(Kind::kRandom, 20000, 10), sorted;
    for (const Key& key : keys) sorter.sort.push(key);
    sorter.sort.finish(
        [&](std::span<const Key> some) { sorted.insert(sorted.end(), some.begin(), some.end()); });
    std::sort(keys.begin(), keys.end());
    EXPECT_TRUE(sorted == keys) << workers;
    EXPECT_LE(sorter.sort.peak_bytes(), workers * ExternalSortRoom::kLeast);
  }
}

TEST(PieceMerge, APieceHasABlockEvenWhereThereIsRoomForNone) {
  using Merge = PieceMerge<Key, uint32_t (*)(const Key&, size_t)>;
  EXPECT_EQ(Merge::step(510, 2, 256), 1U);
  EXPECT_EQ(Merge::step(510, 2, 1), (510U - 4) / 3);
}

// No worker waits for the turn of one that a signal stopped before it had begun.
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
  for (const Key& key : make_keys(Kind::kRandom, 10000, 8)) sort.push(key);
  finishing = true;
  EXPECT_THROW(sort.finish([](std::span<const Key>) {}), Interrupted);
  pretend_interrupt(0);
}

}  // namespace
}  // namespace svdag
