#include "io/help/pages/completion.h"

namespace svdag {
namespace {

// Escapes the brackets and colons of a specification of _arguments.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

// ":N:(thin conservative)": the name of a value and its completions.
std::string value_of(const std::string& name, const ManualOption& option) {
  std::string action;
  if (!option.choices.empty()) {
    action = "(" + join_words(option.choices) + ")";
  } else if (takes_folders(option)) {
    action = "_files -/";
  } else if (takes_any_file(option)) {
    action = "_files";
  } else if (!option.endings.empty()) {
    for (const std::string& ending : option.endings)
      action += (action.empty() ? "" : "|") + ending.substr(1);
    action = "_files -g \"(#i)*.(" + action + ")(-.)\"";
  }
  return ":" + escaped(name) + ":" + action;
}

// One specification per name. It excludes the other names unless the option may be repeated.
std::string specifications(const ManualOption& option) {
  std::string out;
  for (const std::string& name : option.names) {
    std::string spec = option.repeated ? "*" : "(" + join_words(option.names) + ")";
    spec += name;
    if (!option.value.empty()) spec += name[1] == '-' ? "=" : "+";
    spec += "[" + escaped(option.text) + "]";
    if (!option.value.empty()) spec += value_of(option.value, option);
    out += " \\\n    " + single_quoted(spec);
  }
  return out;
}

std::string function_of(const Manual& command) {
  std::string out =
      "_" + replace_all(page_of(command.command), "-", "_") + "() {\n  _arguments -s -S";
  for (const ManualOption& option : command.options) out += specifications(option);
  for (const ManualOption& operand : command.operands) {
    const std::string prefix = operand.repeated ? "*" : operand.required ? "" : ":";
    out += " \\\n    " + single_quoted(prefix + value_of(operand.names.front(), operand));
  }
  return out + "\n}\n\n";
}

// A program with commands: the first word selects the function that completes the rest.
std::string dispatcher_of(const Manual& program) {
  std::string out =
      "_" + replace_all(program.command, "-", "_") +
      "_commands() {\n  local curcontext=$curcontext state line\n  local -a commands\n"
      "  commands=(\n";
  for (const Manual& command : program.commands)
    out += "    " + single_quoted(name_in_program(command) + ":" + escaped(command.text)) + "\n";
  out += "  )\n  _arguments -C";
  for (const ManualOption& option : program.options) out += specifications(option);
  out +=
      " \\\n    '1:command:->command' '*::argument:->rest'\n  case $state in\n"
      "    command) _describe -t commands command commands ;;\n    rest)\n      case $words[1] "
      "in\n";
  for (const Manual& command : program.commands)
    out += "        " + name_in_program(command) + ") _" +
           replace_all(page_of(command.command), "-", "_") + " ;;\n";
  return out + "      esac\n      ;;\n  esac\n}\n\n";
}

}  // namespace

std::string zsh_completion(const std::vector<Manual>& programs) {
  std::string names, functions, cases;
  for (const Manual& program : programs) {
    names += " " + program.command;
    std::string function = "_" + replace_all(program.command, "-", "_") + "_commands";
    if (program.commands.empty()) {
      functions +=
          replace_all(function_of(program), "_" + replace_all(program.command, "-", "_") + "()",
                      function + "()");
    } else {
      for (const Manual& command : program.commands) functions += function_of(command);
      functions += dispatcher_of(program);
    }
    cases += "  " + program.command + ") " + function + " \"$@\" ;;\n";
  }
  return "#compdef" + names + "\n# Completion for zsh.\n\n" + functions + "case $service in\n" +
         cases + "esac\n";
}

}  // namespace svdag
