#include "io/help/usage_error.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>

#include "io/suggest.h"

namespace svdag {
namespace {

// The name of an option without its value, as in "--size=4" and "-j4"; "" if `word` is none.
std::string option_name(const std::string& word) {
  if (word.starts_with("--")) return word.substr(0, word.find('='));
  const bool is_short = word.size() > 1 && word[0] == '-' && std::isalpha(uint8_t(word[1])) != 0;
  return is_short ? word.substr(0, 2) : "";
}

const ManualOption* find_option(const Manual& command, const std::string& name) {
  for (const ManualOption& option : command.options)
    if (std::ranges::find(option.names, name) != option.names.end()) return &option;
  return nullptr;
}

// The message about word i, without a hint at --help.
std::string explain_value(const Manual& command, std::span<const std::string> words, size_t i) {
  const std::string& word = words[i];
  const std::string name = option_name(word), value = word.substr(name.size());
  if (value == "=" && name.size() > 2) return name + ": the value is empty";
  if (value.starts_with("=") && name.size() == 2)
    return word + ": the value starts with \"=\": remove the \"=\"";
  if (!value.empty() || i + 1 == words.size()) return "";
  if (words[i + 1].empty()) return name + ": the value is empty";
  if (find_option(command, option_name(words[i + 1])) == nullptr) return "";
  return name + ": its value is missing before " + words[i + 1];
}

// The text before and after the first `separator`; without one, all of it and "".
std::pair<std::string, std::string> split(const std::string& text, const std::string& separator) {
  const size_t at = text.find(separator);
  if (at == text.npos) return {text, ""};
  return {text.substr(0, at), text.substr(at + separator.size())};
}

}  // namespace

const Manual& command_of(const Manual& program, std::span<const std::string> words) {
  const auto word = std::ranges::find_if(words, [](const auto& w) { return !w.starts_with("-"); });
  if (word == words.end()) return program;
  const auto found =
      std::ranges::find(program.commands, program.command + " " + *word, &Manual::command);
  return found == program.commands.end() ? program : *found;
}

std::string explain_words(const Manual& program, std::span<const std::string> words) {
  const Manual& command = command_of(program, words);
  const std::string see = "; see " + command.command + " --help";
  const auto unknown = [&](const std::string& what, const std::string& guess) {
    return "unknown " + what + " of " + command.command +
           (guess.empty() ? see : "; did you mean " + guess + "?");
  };
  std::vector<std::string> options, commands;
  for (const ManualOption& option : command.options)
    options.insert(options.end(), option.names.begin(), option.names.end());
  for (const Manual& each : command.commands)
    commands.push_back(each.command.substr(program.command.size() + 1));
  for (size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    const std::string &word = words[i], name = option_name(word);
    if (name == "-h" || name == "--help" || name == "-V" || name == "--version") break;
    if (name.empty() && !commands.empty()) {
      std::string guess = command_of_other_program(word);
      if (word == "version") guess = program.command + " --version";
      return unknown("command \"" + word + "\"", guess.empty() ? nearest(word, commands) : guess);
    }
    if (name.empty()) continue;
    const ManualOption* option = find_option(command, name);
    if (option == nullptr) return unknown("option " + name, nearest(name, options));
    if (option->value.empty()) continue;
    const std::string problem = explain_value(command, words, i);
    if (!problem.empty()) return problem + see;
    if (name == word) ++i;  // the value
  }
  return "";
}

// The messages in quotes are those of CLI11 2.1 to 2.4.
std::string plain_usage_error(const std::string& message) {
  const auto [name, rest] = split(message, ": ");
  if (rest.starts_with("At Most 1 required")) return name + ": is given more than once";
  if (rest.ends_with(" missing")) return name + ": the value is missing";
  if (name == "Could not convert") {
    const auto [option, value] = split(rest, " = ");
    return option + ": \"" + value + "\" is not a number";
  }
  if (name.ends_with(" not expected")) return "unexpected argument: " + rest;
  const auto [one, other] = split(message, " excludes ");
  if (!other.empty()) return one + " cannot be combined with " + other;
  std::istringstream names(split(split(message, " from [").second, "]").first);
  std::string choices;  // of "-r,--resolution,-s,--voxel-size"
  for (std::string each; std::getline(names, each, ',');)
    if (each.starts_with("--")) choices += (choices.empty() ? "" : " or ") + each;
  if (choices.empty()) return message;
  const bool none = message.starts_with("Exactly") && !message.ends_with(" were given");
  return (none ? "give one of " : "give only one of ") + choices;
}

}  // namespace svdag
