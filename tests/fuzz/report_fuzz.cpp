// Arbitrary bytes as the report of a bake: a page in which no text of the report is markup, or an
// Error. HASH in them is replaced by the content hash of the report's file.
#include <cstdlib>

#include "io/dag/dag_stats.h"
#include "tests/fuzz/file_fuzz.h"
#include "tests/verify/raw_dag.h"
#include "verify/integrity/integrity.h"
#include "verify/report/report_html.h"

namespace svdag {
namespace {

// A small file and its statistics, as the command computes them.
struct Baked {
  MemoryFile memory{RawFile(raw_dag(test_grid(5), {{1, 2, 3}, {9, 10, 11}, {31, 31, 0}})).bytes()};
  DagFile file = DagFile::open(memory.file().path());
  DagStats stats = compute_stats(file);
  IntegrityReport integrity = inspect(file.header(), file.view(), file.metadata());
  std::string hash = to_hex(file.header().content_hash);
};

void try_report(std::string text) {
  static const Baked baked;
  const size_t place = text.find("HASH");
  if (place != std::string::npos) text.replace(place, 4, baked.hash);
  const std::string page =
      report_html({{"r.json", text}}, baked.file, baked.stats, baked.integrity, {}).html;
  if (page.find("<q") != std::string::npos || page.find('\0') != std::string::npos) std::abort();
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  const std::string text(reinterpret_cast<const char*>(data), size);
  expect_only_errors([&] {
    try {
      try_report(text);
    } catch (const Error& error) {
      if (error.code() != ExitCode::kUsage) throw;  // of another bake
    }
  });
  return 0;
}
