// Arbitrary bytes as the journal of a bake, unchanged and with repaired checksums: its complete
// records are a saved bake, which can be written and read again, or an Error. A journal of another
// layout is empty.
#include "builder/bake/saved_bake.h"
#include "tests/fuzz/file_fuzz.h"
#include "tests/fuzz/own_folder.h"
#include "tests/repair_files.h"

namespace svdag {
namespace {

JournalRecord record_of(SavedKind kind, const RecordWriter& record) {
  return {uint32_t(kind), {record.bytes().begin(), record.bytes().end()}};
}

// Must not throw.
void write_and_read_again(const SavedBake& saved) noexcept {
  std::vector<JournalRecord> records = {
      record_of(SavedKind::kBake, bake_record(saved.description, saved.grid, saved.block_bytes))};
  if (saved.split) records.push_back(record_of(SavedKind::kSplit, split_record(*saved.split)));
  for (const BakedRun& run : saved.runs)
    records.push_back(record_of(SavedKind::kRun, run_record(run)));
  if (saved.baked) {
    records.push_back(record_of(SavedKind::kBaked, baked_record(*saved.baked)));
    if (saved.split) records.push_back(record_of(SavedKind::kSplit, split_record(*saved.split)));
    for (const BakedRun& run : saved.runs)
      records.push_back(record_of(SavedKind::kRun, run_record(run)));
  }
  for (const SpillStream& colours : saved.colours)
    records.push_back(record_of(SavedKind::kColours, colours_record(saved.coloured, colours)));
  const SavedBake again = read_saved(records, "again");
  const bool same =
      again.description == saved.description && again.grid == saved.grid &&
      again.runs.size() == saved.runs.size() &&
      again.split.has_value() == saved.split.has_value() &&
      again.baked.has_value() == saved.baked.has_value() && again.coloured == saved.coloured &&
      again.colours.size() == saved.colours.size() && again.run_blocks == saved.run_blocks;
  if (!same) std::abort();
}

SavedBake read_or_none(const std::vector<JournalRecord>& records) {
  try {
    return read_saved(records, "journal");
  } catch (const Error& error) {
    if (error.code() != ExitCode::kUsage) throw;
    return {};
  }
}

void try_journal(const std::string& bytes) {
  static OwnFolder folder;
  folder.write("journal", bytes);
  std::vector<JournalRecord> records;
  Journal journal(folder.folder().open("journal"), &records);
  expect_only_errors(
      [&] {
        const SavedBake saved = read_or_none(records);
        if (saved.block_bytes != 0) write_and_read_again(saved);
        journal.append(uint32_t(SavedKind::kSession), {});
      },
      ExitCode::kOutput);
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  svdag::try_journal(bytes);
  svdag::repair_journal(&bytes);
  svdag::try_journal(bytes);
  return 0;
}
