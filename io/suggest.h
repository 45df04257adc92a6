// What a word on a command line was meant to be.
//
// Nearest by the number of letters that were left out, added, changed or swapped with their
// neighbour (Damerau 1964; the restricted form, where no piece is edited twice).
#pragma once

#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace svdag {

size_t edit_distance(std::string_view a, std::string_view b);

// The candidate nearest to `word`, the first one of equals; "" if none is near enough to have been
// meant: at most every third letter may be wrong.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

// Where a command is that another program of the project has: "svdag-verify check" for "check", or
// for its program's name ("verify", "svdag-verify") that; "" for other words.
std::string elsewhere(std::string_view word);

struct CommandWords {
  std::string name;                  // "": the program itself
  std::vector<std::string> options;  // with their dashes
};

// A message about the first argument that is neither a command nor an option of its command, with
// the most similar one; "" if all are known. `arguments` without the program's name. A program
// whose only entry is its own has no commands.
std::string explain_unknown(const std::string& program, std::span<const CommandWords> commands,
                            std::span<const std::string> arguments);

// Restates an error message of CLI11 in the style of this program's messages; returns a message that
// it does not know unchanged. The tests of each program hold the messages that users can get.
std::string plain_usage_error(const std::string& message);

// The options of a command of CLI11 (App), those in its groups included.
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

// What is wrong with a command line that CLI11 could not parse, as `error` says, unless a word of
// it is unknown. `words`: without the program's name.
template <class App>
std::string explain(const App& app, const std::vector<std::string>& words,
                    const std::exception& error) {
  std::vector<CommandWords> commands = {{"", option_names(app)}};
  for (const App* command : app.get_subcommands({})) {
    if (!command->get_name().empty())  // else a group, whose options are the program's
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
