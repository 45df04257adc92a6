#include "streaming/error.h"

namespace svdag {
namespace {

std::string compose(const std::string& sentence, const std::string& path,
                    std::optional<uint64_t> offset) {
  std::string text = path.empty() ? sentence : path + ": " + sentence;
  if (offset) text += " (at byte " + std::to_string(*offset) + ")";
  return text;
}

}  // namespace

Error::Error(ExitCode code, const std::string& sentence, const std::string& path,
             std::optional<uint64_t> offset)
    : std::runtime_error(compose(sentence, path, offset)),
      code_(code),
      path_(path),
      offset_(offset) {}

void fail_input(const std::string& path, const std::string& sentence,
                std::optional<uint64_t> offset) {
  throw Error(ExitCode::kBadInput, sentence, path, offset);
}

void fail_usage(const std::string& sentence) {
  throw Error(ExitCode::kUsage, sentence);
}

void assertion_failed(const char* condition, const char* file, int line) {
  const std::string name = std::string(file).substr(std::string(file).find_last_of('/') + 1);
  throw Error(ExitCode::kInternal, "internal error: \"" + std::string(condition) +
                                       "\" does not hold (" + name + ":" + std::to_string(line) +
                                       "); no output was written, please report this");
}

}  // namespace svdag
