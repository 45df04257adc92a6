// Arbitrary bytes as a `.run`, unchanged and with repaired checksums: an Error, or a run
// that passes check_run() and whose levels can be read.
#include "builder/run/run_check.h"
#include "tests/fuzz/file_fuzz.h"
#include "tests/repair_files.h"

namespace svdag {
namespace {

void try_run(const std::string& bytes) {
  expect_only_errors([&] {
    const MemoryFile memory(bytes);
    MemoryBudget budget(uint64_t(64) << 20);
    const RunFile run = RunFile::open(memory.file().path(), &budget);
    check_run(run, 1, &budget);  // windows of few marks
    for (int level = 0; level < run.grid().levels - 1; ++level) {
      uint64_t size = 0;
      const auto blocks = run.read(level, &budget);
      for (auto block = blocks->next(); !block.empty(); block = blocks->next())
        size += block.size();
      if (size != run.layout().levels[level].bytes()) std::abort();
    }
  });
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  svdag::try_run(bytes);
  if (size >= sizeof(svdag::RunHeader)) {
    const uint64_t file_bytes = size;  // else hardly any length but that of a seed is looked at
    std::memcpy(bytes.data() + offsetof(svdag::RunHeader, file_bytes), &file_bytes, 8);
  }
  svdag::repair_run(&bytes);
  svdag::try_run(bytes);
  return 0;
}
