// Arbitrary bytes as a list of bakes: valid command lines or an Error (usage or bad input). Nothing
// is baked.
#include "builder/commands/commands.h"
#include "tests/fuzz/file_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  BatchCommand batch;
  batch.list = memory.file().path();
  expect_only_errors(
      [&] {
        try {
          for (const BakeCommand& bake : bakes_of(batch)) {
            if (bake.build.levels > kMaxLevels) std::abort();
          }
        } catch (const Error& error) {
          if (error.code() != ExitCode::kBadInput) throw;  // no list
        }
      },
      ExitCode::kUsage);
  return 0;
}
