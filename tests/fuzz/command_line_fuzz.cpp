// Arbitrary bytes as a command line of svdag, a word per line: understood, or an Error (usage). It
// is parsed, and nothing is done: no file is touched before a command begins.
#include <CLI/CLI.hpp>

#include "builder/commands/options.h"
#include "io/suggest.h"
#include "tests/fuzz/file_fuzz.h"

namespace svdag {
namespace {

constexpr size_t kMostWords = 64;

void parse(std::vector<std::string> words) {
  CLI::App app("", "svdag");
  BuildCommandConfig build;
  MergeCommandConfig merge;
  PlanCommandConfig plan;
  RunCommandConfig run;
  SubmitConfig submit;
  InfoConfig info;
  add_build(&app, &build);
  add_merge(&app, &merge);
  add_plan(&app, &plan);
  add_run(&app, &run);
  add_submit(&app, &submit);
  add_info(&app, &info);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  try {
    app.parse(int(argv.size()), argv.data());
  } catch (const CLI::Success&) {
  } catch (const CLI::ParseError& error) {
    fail_usage(explain(app, int(argv.size()), argv.data(), error));
  }
  const bool many_threads = build.threads > 1024 || merge.threads > 1024;
  if (many_threads || build.build.levels > kMaxLevels) std::abort();
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::vector<std::string> words = {"svdag"};
  for (size_t i = 0; i < size && words.size() < svdag::kMostWords; ++i) {
    if (i == 0 || data[i] == '\n') words.emplace_back();
    if (data[i] != '\n' && data[i] != 0) words.back() += char(data[i]);
  }
  svdag::expect_only_errors([&] { svdag::parse(std::move(words)); }, svdag::ExitCode::kUsage);
  return 0;
}
