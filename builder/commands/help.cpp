#include "builder/commands/help.h"

#include <algorithm>
#include <cstdio>

#include "builder/commands/sibling.h"
#include "io/help/help_text.h"
#include "io/suggest.h"
#include "streaming/error.h"
#include "streaming/process/terminal.h"

namespace svdag {
namespace {

int print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  return 0;
}

// Whether a command is a separate program, which prints its own help.
bool is_sibling(const std::string& name) {
  return name == "export" || name == "import";
}

// "svdag build --layers, svdag info --layers": the commands with an option of this name; "" if none
// has one.
std::string commands_with(const Manual& program, const std::string& option) {
  std::string list;
  for (const Manual& command : program.commands) {
    for (const ManualOption& each : command.options) {
      if (std::ranges::find(each.names, option) != each.names.end())
        list += (list.empty() ? "" : ", ") + command.command + " " + option;
    }
  }
  return list;
}

[[noreturn]] void print_sibling_help(std::string name) {
  std::string program = "svdag", option = "--help";
  char* arguments[] = {program.data(), name.data(), option.data(), nullptr};
  become_sibling(("svdag-" + name).c_str(), arguments);
}

}  // namespace

std::vector<std::string> help_subjects(const Manual& program) {
  std::vector<std::string> subjects;
  for (const Manual& command : program.commands) {
    std::string name = command.command.substr(command.command.find(' ') + 1);
    if (name != "help") subjects.push_back(std::move(name));
  }
  for (const Topic& topic : topics()) subjects.emplace_back(topic.name);
  return subjects;
}

std::string list_of_topics() {
  std::string list = "Topics:\n";
  for (const Topic& topic : topics()) {
    const std::string what(topic.text.substr(0, topic.text.find('\n')));
    std::string name(topic.name);
    name.resize(std::max<size_t>(name.size(), 12), ' ');
    list += "  " + name + what.substr(what.find(':') + 1) + "\n";
  }
  return list;
}

int run(const HelpCommand& help) {
  const auto& [program, subject] = help;
  const size_t width = text_width(stdout);
  if (subject.empty()) return print(help_text(program, width));
  for (const Topic& topic : topics()) {
    if (topic.name == subject) return print(fill_paragraphs(topic.text, width));
  }
  if (is_sibling(subject)) print_sibling_help(subject);
  for (const Manual& command : program.commands) {
    if (command.command == program.command + " " + subject) return print(help_text(command, width));
  }
  const std::string there = command_of_other_program(subject);
  const std::string with = commands_with(program, "--" + subject);
  if (there.empty() && !with.empty())
    fail_usage("\"" + subject + "\" is an option: " + with + "; see the help of these commands");
  const std::string guess =
      there.empty() ? nearest(subject, help_subjects(program)) : there + " --help";
  fail_usage("unknown command or topic \"" + subject + "\"" +
             (guess.empty() ? "; svdag help lists them" : "; did you mean " + guess + "?"));
}

}  // namespace svdag
