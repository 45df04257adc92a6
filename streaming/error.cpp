#include "streaming/error.h"

#include <new>
#include <system_error>

#include "streaming/printable.h"

namespace svdag {
namespace {

std::string compose(const std::string& sentence, const std::string& path,
                    std::optional<uint64_t> offset) {
  std::string text = path.empty() ? sentence : path + ": " + sentence;
  if (offset) text += " (at byte " + std::to_string(*offset) + ")";
  return printable(text);
}

}  // namespace

Error::Error(ExitCode code, const std::string& sentence, const std::string& path,
             std::optional<uint64_t> offset)
    : std::runtime_error(compose(sentence, path, offset)),
      code_(code),
      path_(path),
      offset_(offset) {}

Error Error::with_hint(const std::string& hint) const {
  return Error(what() + printable(hint), *this);
}

void fail_input(const std::string& path, const std::string& sentence,
                std::optional<uint64_t> offset) {
  throw Error(ExitCode::kBadInput, sentence, path, offset);
}

void fail_usage(const std::string& sentence) {
  throw Error(ExitCode::kUsage, sentence);
}

bool is_lack_of_memory(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return true;
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return system != nullptr && (system->code() == std::errc::resource_unavailable_try_again ||
                               system->code() == std::errc::not_enough_memory);
}

void assertion_failed(const char* condition, const char* file, int line) {
  const std::string name = std::string(file).substr(std::string(file).find_last_of('/') + 1);
  throw Error(ExitCode::kInternal, "internal error: \"" + std::string(condition) +
                                       "\" does not hold (" + name + ":" + std::to_string(line) +
                                       "); no output was written, please report this");
}

}  // namespace svdag
