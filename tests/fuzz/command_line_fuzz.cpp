// Arbitrary bytes as a command line of svdag, a word per line: a command or an Error (usage). The
// command is not run, and parsing accesses no file.
#include <CLI/CLI.hpp>

#include "builder/commands/options.h"
#include "io/help/command_line.h"
#include "tests/fuzz/file_fuzz.h"

namespace svdag {
namespace {

constexpr size_t kMaxWords = 64;

// All commands, constructed once because that takes ten times as long as parsing a line. CLI11
// resets the values of the last line.
class Program {
 public:
  Program() : app_("", "svdag") {
    add_build(&app_, &command_);
    add_batch(&app_, &command_);
    add_merge(&app_, &command_);
    add_plan(&app_, &command_);
    add_run(&app_, &command_);
    add_submit(&app_, &command_);
    add_info(&app_, &command_);
  }

  void parse(const std::vector<std::string>& words) {
    command_ = {};
    try {
      parse_words(&app_, words);
    } catch (const CLI::Success&) {
    }
    const auto* bake = std::get_if<BakeCommand>(&command_);
    const auto* merge = std::get_if<MergeCommand>(&command_);
    if (bake != nullptr && (bake->threads > 1024 || bake->build.levels > kMaxLevels)) std::abort();
    if (merge != nullptr && merge->threads > 1024) std::abort();
  }

 private:
  CLI::App app_;
  Command command_;
};

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::vector<std::string> words;
  for (size_t i = 0; i < size && words.size() < svdag::kMaxWords; ++i) {
    if (i == 0 || data[i] == '\n') words.emplace_back();
    if (data[i] != '\n' && data[i] != 0) words.back() += char(data[i]);
  }
  static svdag::Program program;
  svdag::expect_only_errors([&] { program.parse(words); }, svdag::ExitCode::kUsage);
  return 0;
}
