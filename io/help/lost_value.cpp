#include "io/help/lost_value.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace svdag {
namespace {

const CLI::App& command_of(const CLI::App& program, const std::string& word) {
  for (const CLI::App* each : program.get_subcommands({})) {
    if (!each->get_name().empty() && each->get_name() == word) return *each;
  }
  return program;
}

// A word that begins like an option, divided into name and value, as in "--size=4" and "-j4".
struct OptionWord {
  explicit OptionWord(const std::string& word)
      : is_long(word.starts_with("--")),
        end(is_long ? std::min(word.find('='), word.size()) : std::min<size_t>(2, word.size())),
        name(word.substr(0, end)),
        value(word.substr(end)) {}

  bool is_long;
  size_t end;
  std::string name, value;  // value: including a "="
};

// Like App::get_option_no_throw(), which ends the program where memory is short: it is noexcept.
const CLI::Option* find_option(const CLI::App& command, const std::string& name) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->check_name(name)) return option;
  }
  for (const CLI::App* each : command.get_subcommands({})) {
    const bool is_group = each->get_name().empty();
    if (const CLI::Option* option = is_group ? find_option(*each, name) : nullptr) return option;
  }
  return nullptr;
}

const CLI::Option* option_of(const CLI::App& command, const std::string& word) {
  if (word.size() < 2 || word[0] != '-' || word == "--") return nullptr;
  return find_option(command, OptionWord(word).name);
}

}  // namespace

std::string explain_missing_value(const CLI::App& program, std::span<const std::string> words) {
  if (words.empty()) return "";
  const CLI::App& command = command_of(program, words[0]);
  const std::string where = "; see " + program.get_name() +
                            (&command == &program ? "" : " " + command.get_name()) + " --help";
  for (size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    const CLI::Option* option = option_of(command, words[i]);
    if (option == nullptr || option->get_items_expected_max() == 0) continue;
    const OptionWord word(words[i]);
    if (!word.is_long && word.value.starts_with("="))
      return words[i] + ": the value starts with \"=\": remove the \"=\"" + where;
    if (word.value == "=") return word.name + ": the value is empty" + where;
    if (!word.value.empty() || i + 1 == words.size()) continue;
    const std::string& value = words[++i];
    if (value.empty()) return word.name + ": the value is empty" + where;
    if (option_of(command, value) != nullptr)
      return word.name + ": its value is missing before " + value + where;
  }
  return "";
}

}  // namespace svdag
