// Arbitrary bytes as the journal of a bake, as they are and with their checksums repaired: what is
// whole of it is read, and makes sense or is an Error.
#include "builder/saved_bake.h"
#include "streaming/file_folder.h"
#include "tests/fuzz/file_fuzz.h"
#include "tests/fuzz/own_folder.h"
#include "tests/repair_files.h"

namespace svdag {
namespace {

void try_journal(const std::string& bytes) {
  static const OwnFolder temp;
  static const Folder folder = Folder::open_private(temp.path());
  temp.write("journal", bytes);
  std::vector<JournalRecord> records;
  const Journal journal(folder.open("journal"), &records);
  expect_only_errors(
      [&] {
        const SavedBake saved = read_saved(records, "journal");
        if (!saved.runs.empty() && !saved.grid.is_possible()) std::abort();
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
