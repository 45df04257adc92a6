#include "streaming/spill/spill_file.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <thread>

#include "streaming/file/file_folder.h"
#include "tests/any_of.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

constexpr size_t kBlock = 4096;
constexpr size_t kPayload = kBlock - SpillFile::kHeader;

using Bytes = std::vector<std::byte>;

Bytes random_bytes(size_t size, uint64_t seed) {
  std::mt19937_64 random(seed);
  Bytes bytes(size);
  for (std::byte& byte : bytes) byte = std::byte(random());
  return bytes;
}

SpillStream write(SpillFile* file, uint64_t number, const Bytes& bytes, MemoryBudget* budget) {
  SpillWriter writer(file, number, budget);
  writer.append(bytes);
  EXPECT_EQ(writer.bytes(), bytes.size());
  return writer.finish();
}

Bytes read(SpillFile* file, const SpillStream& stream, MemoryBudget* budget) {
  SpillReader reader(file, stream, budget);
  Bytes bytes;
  for (auto block = reader.next(); !block.empty(); block = reader.next()) {
    EXPECT_EQ(uintptr_t(block.data()) % 64, 0U);
    bytes.insert(bytes.end(), block.begin(), block.end());
    std::ranges::fill(block, std::byte(0xaa));  // the caller may modify the block
  }
  EXPECT_TRUE(reader.next().empty());
  return bytes;
}

struct Spill {
  explicit Spill(size_t block = kBlock, uint64_t limit = MemoryBudget::kUnlimited)
      : budget(limit), file(folder.create("spill"), block) {}
  std::string path() const { return folder.path() + "/spill"; }
  SpillStream write(uint64_t number, const Bytes& bytes) {
    return svdag::write(&file, number, bytes, &budget);
  }
  Bytes read(const SpillStream& stream) { return svdag::read(&file, stream, &budget); }

  TempFolder temp;
  Folder folder = Folder::open_private(temp.path());
  MemoryBudget budget;
  SpillFile file;
};

// Writes `streams` streams, numbered from `first` on, in random order and with appends of random
// sizes; then reads and compares each.
void write_and_read_interleaved(SpillFile* file, MemoryBudget* budget, uint64_t first,
                                size_t streams, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Bytes> expected;
  std::vector<SpillWriter> writers;
  for (size_t s = 0; s < streams; ++s) {
    expected.push_back(random_bytes(random() % (5 * file->payload_bytes()), first + s));
    writers.emplace_back(file, first + s, budget);
  }
  std::vector<SpillStream> done(streams);
  for (size_t left = streams; left > 0;) {
    const size_t s = random() % streams;
    if (done[s].number != 0) continue;
    const uint64_t at = writers[s].bytes();
    const size_t n = std::min<size_t>(expected[s].size() - at, random() % 3000);
    writers[s].append(std::span(expected[s]).subspan(at, n));
    if (at + n < expected[s].size()) continue;
    done[s] = writers[s].finish();
    --left;
  }
  writers.clear();
  for (size_t s = 0; s < streams; ++s) {
    EXPECT_EQ(done[s].number, first + s);
    EXPECT_EQ(read(file, done[s], budget), expected[s]);
    if (s % 2 == 0) file->free(done[s]);
  }
}

TEST(SpillFile, StreamsOfAnySizeAroundABlockAreReadBack) {
  for (const size_t block : {size_t(4096), size_t(3 * 4096)}) {
    Spill spill(block);
    const size_t payload = spill.file.payload_bytes();
    EXPECT_EQ(payload, block - 64);
    uint64_t number = 0;
    for (const size_t n :
         {size_t(0), size_t(1), payload - 1, payload, payload + 1, 2 * payload, 9 * payload - 1}) {
      const Bytes bytes = random_bytes(n, n);
      const SpillStream stream = spill.write(++number, bytes);
      EXPECT_EQ(stream.bytes, n);
      EXPECT_EQ(stream.blocks.size(), (n + payload - 1) / payload);
      EXPECT_EQ(spill.read(stream), bytes);
    }
  }
}

TEST(SpillFile, AReaderMayStartAtAnyBlock) {
  Spill spill;
  const Bytes bytes = random_bytes(3 * kPayload + 100, 5);
  const SpillStream stream = spill.write(7, bytes);
  for (size_t first = 0; first <= stream.blocks.size(); ++first) {
    SpillReader reader(&spill.file, stream, &spill.budget, first);
    Bytes rest;
    for (auto block = reader.next(); !block.empty(); block = reader.next())
      rest.insert(rest.end(), block.begin(), block.end());
    const size_t from = std::min(first * kPayload, bytes.size());
    EXPECT_TRUE(std::ranges::equal(rest, std::span(bytes).subspan(from))) << first;
  }
}

TEST(SpillFile, InterleavedStreamsOfManyThreadsAreReadBack) {
  Spill spill;
  {
    std::vector<std::jthread> threads;
    for (uint64_t t = 1; t <= 4; ++t) {
      threads.emplace_back([&, t] {
        for (uint64_t round = 0; round < 5; ++round)
          write_and_read_interleaved(&spill.file, &spill.budget, t * 1000 + round * 100, 10, t);
      });
    }
  }
  EXPECT_EQ(spill.budget.used(), 0U);
  spill.file.sync();
  EXPECT_EQ(std::filesystem::file_size(spill.path()), spill.file.peak_bytes());
}

RC_GTEST_PROP(SpillFile, AppendsOfAnySizesMakeOneStream, ()) {
  Spill spill;
  const auto sizes = *rc::gen::container<std::vector<size_t>>(any_of<size_t>(0, 9000));
  Bytes expected;
  SpillWriter writer(&spill.file, 1, &spill.budget);
  for (const size_t n : sizes) {
    const Bytes bytes = random_bytes(n, n);
    writer.append(bytes);
    expected.insert(expected.end(), bytes.begin(), bytes.end());
  }
  RC_ASSERT(spill.read(writer.finish()) == expected);
}

TEST(SpillFile, CanBeResumedFromTheListOfItsStreams) {
  const TempFolder temp;
  const Folder folder = Folder::open_private(temp.path());
  MemoryBudget budget;
  const Bytes bytes = random_bytes(3 * kPayload, 1), more = random_bytes(2 * kPayload, 2);
  SpillStream stream;
  {
    SpillFile file(folder.create("spill"), kBlock);
    stream = write(&file, 1, bytes, &budget);
    file.sync();
  }
  SpillFile file(folder.open("spill"), kBlock, 3);
  EXPECT_EQ(file.peak_bytes(), 3 * kBlock);
  EXPECT_EQ(read(&file, write(&file, 2, more, &budget), &budget), more);
  EXPECT_EQ(read(&file, stream, &budget), bytes);
}

TEST(SpillFile, TooManyBlocksAreAnErrorForEachWriter) {
  const TempFolder temp;
  const Folder folder = Folder::open_private(temp.path());
  MemoryBudget budget;
  SpillFile file(folder.create("spill"), kBlock, UINT32_MAX);
  SpillWriter own(&file, 1, &budget);
  EXPECT_SVDAG_ERROR(own.append(random_bytes(2 * kPayload, 1)), ExitCode::kOutput,
                     "more than 2^32 - 1 blocks");
  SpillWriter other(&file, 2, &budget);
  other.append(random_bytes(10, 2));
  EXPECT_SVDAG_ERROR(other.finish(), ExitCode::kOutput, "more than 2^32 - 1 blocks");
}

TEST(SpillFile, ReusesBlocksOfFreedStreamsAndUnfinishedWriters) {
  Spill spill;
  const SpillStream first = spill.write(1, random_bytes(4 * kPayload, 1));
  const SpillStream second = spill.write(2, random_bytes(4 * kPayload, 2));
  EXPECT_EQ(spill.file.peak_bytes(), 8 * kBlock);
  spill.file.free(first);
  EXPECT_EQ(spill.write(3, random_bytes(4 * kPayload, 3)).blocks, first.blocks);
  spill.file.free(second);
  { SpillWriter(&spill.file, 4, &spill.budget).append(random_bytes(3 * kPayload, 4)); }
  const Bytes last = random_bytes(4 * kPayload, 5);
  EXPECT_EQ(spill.read(spill.write(5, last)), last);
  EXPECT_EQ(spill.file.peak_bytes(), 8 * kBlock);
  spill.file.sync();
  EXPECT_EQ(spill.file.written_bytes(), (4 + 4 + 4 + 3 + 4) * kBlock);
  EXPECT_EQ(spill.file.read_bytes(), 4 * kBlock);
}

TEST(SpillFile, ReservesAndReleasesItsBuffers) {
  Spill spill(kBlock, 100 * kBlock);
  const Bytes bytes = random_bytes(10 * kPayload + 1, 1);
  SpillStream stream;
  {
    SpillWriter writer(&spill.file, 1, &spill.budget);
    EXPECT_EQ(spill.budget.used(), 0U);
    writer.append(std::span(bytes).first(1));
    EXPECT_EQ(spill.budget.used(), kBlock);
    writer.append(std::span(bytes).subspan(1));
    EXPECT_EQ(spill.budget.used(), 2 * kBlock);
    stream = writer.finish();
  }
  EXPECT_EQ(spill.budget.used(), 0U);
  {
    SpillReader reader(&spill.file, stream, &spill.budget);
    reader.next();
    EXPECT_EQ(spill.budget.used(), 2 * kBlock);
  }
  EXPECT_EQ(spill.budget.used(), 0U);
  EXPECT_EQ(spill.budget.peak(), 2 * kBlock);
}

TEST(SpillFile, ManyWritersShareFourSpareBlocks) {
  Spill spill;
  {
    std::vector<SpillWriter> writers;
    for (uint64_t s = 0; s < 20; ++s) writers.emplace_back(&spill.file, s, &spill.budget);
    for (SpillWriter& writer : writers) writer.append(random_bytes(3 * kPayload + 1, 1));
    EXPECT_LE(spill.budget.peak(), (20 + 4) * kBlock);
    while (writers.size() > 1) writers.pop_back();
    EXPECT_LE(spill.budget.used(), 2 * kBlock);
  }
  EXPECT_EQ(spill.budget.used(), 0U);
}

TEST(SpillFile, WithoutMemoryForASecondBlockAWriterWaitsAndAReaderFails) {
  Spill spill(kBlock, kBlock);
  const Bytes bytes = random_bytes(5 * kPayload, 1);
  const SpillStream stream = spill.write(1, bytes);
  EXPECT_EQ(spill.budget.peak(), kBlock);
  EXPECT_SVDAG_ERROR(spill.read(stream), ExitCode::kMemory, "spill buffers");
  EXPECT_EQ(spill.budget.used(), 0U);
  MemoryBudget enough;
  EXPECT_EQ(read(&spill.file, stream, &enough), bytes);
}

void expect_damaged(Spill* spill, const SpillStream& stream) {
  EXPECT_SVDAG_ERROR(spill->read(stream), ExitCode::kOutput, "spill: scratch file is damaged");
}

// spill_block_test.cpp flips every bit of a block; this test flips some bits on disk.
TEST(SpillFile, FlippedBitsOnDiskAreDetected) {
  Spill spill;
  const Bytes bytes = random_bytes(3 * kPayload + 5, 1);
  const SpillStream stream = spill.write(1, bytes);
  spill.file.sync();
  File disk = spill.folder.open("spill");
  for (size_t i = 0; i < 4 * kBlock; i += i % kBlock < 80 ? 1 : 331) {
    std::byte before;
    disk.read_at(i, std::span(&before, 1));
    const std::byte flipped = before ^ std::byte(1 << i % 8);
    disk.write_at(i, std::span(&flipped, 1));
    expect_damaged(&spill, stream);
    disk.write_at(i, std::span(&before, 1));
  }
  EXPECT_EQ(spill.read(stream), bytes);
}

TEST(SpillFile, SwappedStaleAndMissingBlocksAreDetected) {
  Spill spill;
  const Bytes bytes = random_bytes(4 * kPayload, 1);
  const SpillStream one = spill.write(1, bytes), two = spill.write(2, bytes);

  SpillStream swapped = one;
  std::swap(swapped.blocks[1], swapped.blocks[2]);
  expect_damaged(&spill, swapped);
  SpillStream foreign = one;
  foreign.blocks[3] = two.blocks[3];
  expect_damaged(&spill, foreign);
  SpillStream beyond = one;
  beyond.blocks[3] = 1000;
  expect_damaged(&spill, beyond);
  SpillStream shorter = one;
  shorter.bytes -= 1;
  expect_damaged(&spill, shorter);
  SpillStream cut = one;
  cut.blocks.pop_back();
  expect_damaged(&spill, cut);

  spill.file.free(one);
  spill.write(3, bytes);
  expect_damaged(&spill, one);
  EXPECT_EQ(spill.read(two), bytes);
}

TEST(SpillFile, ATruncatedFileIsDetected) {
  Spill spill;
  const SpillStream stream = spill.write(1, random_bytes(4 * kPayload, 1));
  spill.file.sync();
  spill.folder.open("spill").truncate(3 * kBlock + 100);
  expect_damaged(&spill, stream);
}

// Runs in a child process, in which files cannot grow beyond 16 blocks.
int fail_to_write() {
  signal(SIGXFSZ, SIG_IGN);
  const rlimit limit = {16 * kBlock, 16 * kBlock};
  setrlimit(RLIMIT_FSIZE, &limit);
  Spill spill;
  SpillWriter writer(&spill.file, 1, &spill.budget), other(&spill.file, 2, &spill.budget);
  const auto fails = [&](const auto& work) {
    try {
      work();
      return false;
    } catch (const Error& error) {
      const std::string what = error.what();
      return error.code() == ExitCode::kOutput &&
             what.find("/spill: cannot be written: ") != what.npos;
    }
  };
  other.append(Bytes(10));
  if (!fails([&] { writer.append(Bytes(30 * kPayload)); })) return 1;
  if (!fails([&] { writer.append(Bytes(1)); })) return 2;
  if (!fails([&] { writer.finish(); })) return 3;
  if (!fails([&] { other.finish(); })) return 4;
  if (!fails([&] { spill.file.sync(); })) return 5;
  if (!fails([&] { spill.read({1, kPayload, {0}}); })) return 6;
  return 0;
}

TEST(SpillFile, AfterAFailedWriteAllOperationsThrowItsError) {
  const pid_t child = fork();
  if (child == 0) _exit(fail_to_write());
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << WEXITSTATUS(status);
}

}  // namespace
}  // namespace svdag
