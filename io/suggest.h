// Suggestions for misspelt commands and options.
//
// Words are compared by their edit distance: the number of letters left out, added, changed or
// swapped with a neighbour (Damerau 1964; the restricted form, where no substring is edited twice).
#pragma once

#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace svdag {

size_t edit_distance(std::string_view a, std::string_view b);

// The candidate nearest to `word`, the first of equals; "" if more than every third letter of
// `word` is wrong.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

// The command of another program of the project: "svdag-verify check" for "check", "svdag-verify"
// for "verify" or "svdag-verify"; "" for other words.
std::string command_of_other_program(std::string_view word);

struct CommandWords {
  std::string name;                  // "": the program itself
  std::vector<std::string> options;  // with their dashes
};

// A message about the first argument that is neither a command nor an option of its command, with a
// suggestion; "" if all are known. `arguments` does not include the program's name. `commands` of a
// program without commands has one element, the program itself.
std::string explain_unknown(const std::string& program, std::span<const CommandWords> commands,
                            std::span<const std::string> arguments);

// Rewrites an error message of CLI11 in the style of this program's messages. Returns other
// messages unchanged.
std::string plain_usage_error(const std::string& message);

// The options of a CLI11 command, including those of its option groups.
template <class App>
std::vector<std::string> option_names(const App& app) {
  std::vector<std::string> names;
  for (const auto* option : app.get_options()) {
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const App* group : app.get_subcommands({})) {
    if (!group->get_name().empty()) continue;
    for (std::string& name : option_names(*group)) names.push_back(std::move(name));
  }
  return names;
}

// A message about a command line that CLI11 could not parse: the first unknown word if there is
// one, else `error`. `words` does not include the program's name.
template <class App>
std::string explain(const App& app, const std::vector<std::string>& words,
                    const std::exception& error) {
  std::vector<CommandWords> commands = {{"", option_names(app)}};
  for (const App* command : app.get_subcommands({})) {
    if (!command->get_name().empty())  // else an option group, part of the program itself
      commands.push_back({command->get_name(), option_names(*command)});
  }
  const std::string unknown = explain_unknown(app.get_name(), commands, words);
  if (!unknown.empty()) return unknown;
  std::string whole = app.get_name();
  for (const CommandWords& command : commands) {
    if (!words.empty() && !command.name.empty() && command.name == words[0])
      whole += " " + command.name;
  }
  return plain_usage_error(error.what()) + "; see " + whole + " --help";
}

}  // namespace svdag
