#include "streaming/spill/journal.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <filesystem>

#include "streaming/file/file_folder.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

using Payload = std::vector<std::byte>;

Payload payload_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

class JournalFile {
 public:
  std::vector<JournalRecord> read() { return open().second; }
  std::pair<Journal, std::vector<JournalRecord>> open() {
    std::vector<JournalRecord> records;
    Journal journal(folder_.open_or_create("journal"), &records);
    return {std::move(journal), std::move(records)};
  }
  std::string bytes() const { return temp_.read("journal"); }
  void set(const std::string& bytes) { temp_.write("journal", bytes); }

 private:
  TempFolder temp_;
  Folder folder_ = Folder::open_private(temp_.path());
};

// Writes four records; returns the size of the journal before the first and after each.
std::vector<size_t> write_four(JournalFile* file) {
  std::vector<size_t> ends = {0};
  Journal journal = file->open().first;
  for (const char* text : {"first", "", "the third of them", "4"}) {
    journal.append(uint32_t(ends.size()), payload_of(text));
    ends.push_back(file->bytes().size());
  }
  return ends;
}

void expect_first(size_t count, const std::vector<JournalRecord>& records) {
  const std::string_view texts[] = {"first", "", "the third of them", "4"};
  ASSERT_EQ(records.size(), count);
  for (size_t i = 0; i < count; ++i) {
    EXPECT_EQ(records[i].kind, i + 1);
    EXPECT_EQ(records[i].payload, payload_of(texts[i]));
  }
}

TEST(Journal, IsEmptyAtFirst) {
  JournalFile file;
  EXPECT_TRUE(file.read().empty());
  EXPECT_EQ(file.bytes(), "");
}

RC_GTEST_PROP(Journal, ReadsRecordsAppendedInManySessions,
              (const std::vector<std::pair<uint32_t, std::string>>& records)) {
  JournalFile file;
  size_t count = 0;
  for (const auto& [kind, text] : records) {
    auto [journal, before] = file.open();
    RC_ASSERT(before.size() == count++);
    journal.append(kind, payload_of(text));
  }
  const auto read = file.read();
  RC_ASSERT(read.size() == records.size());
  for (size_t i = 0; i < read.size(); ++i) {
    RC_ASSERT(read[i].kind == records[i].first);
    RC_ASSERT(read[i].payload == payload_of(records[i].second));
  }
}

TEST(Journal, TruncatedAnywhereItKeepsCompleteRecordsAndContinues) {
  JournalFile file;
  const auto ends = write_four(&file);
  const std::string whole = file.bytes();
  for (size_t cut = 0; cut <= whole.size(); ++cut) {
    file.set(whole.substr(0, cut));
    const size_t kept = size_t(std::ranges::upper_bound(ends, cut) - ends.begin()) - 1;
    expect_first(kept, file.read());
    EXPECT_EQ(file.bytes().size(), ends[kept]) << cut;  // the incomplete record was removed
    file.open().first.append(9, payload_of("more"));
    EXPECT_EQ(file.read().size(), kept + 1);
  }
}

TEST(Journal, AFlippedBitEndsItBeforeTheDamagedRecord) {
  JournalFile file;
  const auto ends = write_four(&file);
  const std::string whole = file.bytes();
  for (size_t bit = 0; bit < whole.size() * 8; ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = char(damaged[bit / 8] ^ (1 << bit % 8));
    file.set(damaged);
    expect_first(size_t(std::ranges::upper_bound(ends, bit / 8) - ends.begin()) - 1, file.read());
  }
}

TEST(Journal, RemovesZerosAndGarbageAtTheEnd) {
  for (const char fill : {'\0', '\xff', 'a'}) {
    JournalFile file;
    const auto ends = write_four(&file);
    file.set(file.bytes() + std::string(10'000, fill));
    expect_first(4, file.read());
    EXPECT_EQ(file.bytes().size(), ends.back());
  }
}

TEST(Journal, RejectsAHugeLength) {
  TempFolder temp;
  Folder folder = Folder::open_private(temp.path());
  File sparse = folder.create("journal");
  const uint32_t tag[] = {1, 0xffffffff};
  sparse.write_at(0, std::as_bytes(std::span(tag)));
  sparse.truncate(uint64_t(1) << 33);  // the file is long enough for the length
  std::vector<JournalRecord> records;
  Journal(std::move(sparse), &records);
  EXPECT_TRUE(records.empty());
  EXPECT_EQ(std::filesystem::file_size(temp.file("journal")), 0U);
}

TEST(Journal, ARecordThatIsTooLongIsAnErrorAndNotWritten) {
  JournalFile file;
  auto [journal, records] = file.open();
  const std::byte first{};  // the rest is not read
  const std::span<const std::byte> payload(&first, (size_t(1) << 30) + 1);
  EXPECT_SVDAG_ERROR(journal.append(1, payload), ExitCode::kOutput, "more than 2^30 bytes");
  EXPECT_EQ(file.bytes(), "");
}

TEST(Journal, NothingIsAppendedAfterAFailedAppend) {
  JournalFile file;
  auto [journal, records] = file.open();
  journal.append(1, payload_of("first"));
  const std::string before = file.bytes();
  const std::byte first{};  // the rest is not read
  const std::span<const std::byte> payload(&first, (size_t(1) << 30) + 1);
  EXPECT_SVDAG_ERROR(journal.append(2, payload), ExitCode::kOutput, "more than 2^30 bytes");
  EXPECT_SVDAG_ERROR(journal.append(3, payload_of("third")), ExitCode::kOutput,
                     "more than 2^30 bytes");
  EXPECT_EQ(file.bytes(), before);
}

TEST(Journal, AFailedWriteIsAnOutputError) {
  TempFolder temp;
  std::vector<JournalRecord> records;
  Journal journal(File::open_read(temp.write("read-only", "")), &records);
  EXPECT_SVDAG_ERROR(journal.append(1, payload_of("x")), ExitCode::kOutput,
                     "read-only: cannot be written");
}

}  // namespace
}  // namespace svdag
