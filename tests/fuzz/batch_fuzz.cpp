// Arbitrary bytes as a list of bakes: command lines that make sense, or an Error (usage, or no
// list). Nothing is baked.
#include <CLI/CLI.hpp>

#include "builder/commands/options.h"
#include "tests/fuzz/file_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  static const auto parse = [] {
    CLI::App app("", "svdag");
    BuildCommandConfig config;
    add_build(&app, &config);
    return config.parse;
  }();
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  BuildCommandConfig batch;
  batch.batch = memory.file().path();
  batch.parse = parse;
  expect_only_errors(
      [&] {
        try {
          for (const BuildCommandConfig& bake : bakes_of_batch(batch)) {
            if (bake.build.levels > kMaxLevels || !bake.batch.empty()) std::abort();
          }
        } catch (const Error& error) {
          if (error.code() != ExitCode::kBadInput) throw;  // no list
        }
      },
      ExitCode::kUsage);
  return 0;
}
