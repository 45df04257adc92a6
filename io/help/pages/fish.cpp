#include "io/help/pages/completion.h"

namespace svdag {
namespace {

// In single quotes, fish has two escapes: \\ and \'.
std::string fish_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
  return out + "'";
}

// The arguments of `complete` for a value; @ is the prefix of the program's functions.
std::string value_completion(const ManualOption& option) {
  if (!option.choices.empty()) return " -x -a " + fish_quoted(join_words(option.choices));
  if (takes_folders(option)) return " -x -a '(__fish_complete_directories (@_value))'";
  if (takes_any_file(option)) return " -r -F";
  if (option.endings.empty()) return " -x";
  return " -x -k -a '(@_files " + join_words(option.endings) + ")'";
}

std::string lines_of(const Manual& command, const std::string& condition) {
  const std::string start = "complete -c @COMMAND -n '" + condition + "'";
  std::string out;
  for (const ManualOption& option : command.options) {
    out += start;
    for (const std::string& name : option.names)
      out += name[1] == '-' ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.value.empty()) out += value_completion(option);
    out += " -d " + fish_quoted(option.text) + "\n";
  }
  for (const ManualOption& operand : command.operands)
    out += start + replace_all(value_completion(operand), " -x", "") + "\n";
  return out;
}

constexpr const char* kFunctions = R"fish(
# Whether the command is one of these words.
function @_is
    set -l words (commandline -opc)
    set -q words[2]; and contains -- $words[2] $argv
end

# The value so far: the word, or the part after the = of its option.
function @_value
    string replace -r -- '^--[^=]*=' '' (commandline -ct)
end

# Folders, and files with these endings.
function @_files
    set -l files (complete -C "__fish_command_without_completions "(@_value))
    string match -r -- '^.*/$' $files
    for ending in $argv
        string match -r -- '(?i)^.*'(string escape --style=regex -- $ending)'$' $files
    end
    return 0
end
)fish";

}  // namespace

std::string fish_completion(const Manual& program) {
  std::string out = "# Completion of @COMMAND for fish.\n" + std::string(kFunctions) +
                    "\ncomplete -c @COMMAND -f\n";
  const std::string first =
      program.commands.empty() ? "true" : "test (count (commandline -opc)) -eq 1";
  out += lines_of(program, first);
  for (const Manual& command : program.commands) {
    const std::string name = name_in_program(command);
    out += "complete -c @COMMAND -n '" + first + "' -a " + name + " -d " +
           fish_quoted(command.text) + "\n";
    out += lines_of(command, "@_is " + name);
  }
  out = replace_all(out, "@COMMAND", program.command);
  return replace_all(out, "@_", "__" + replace_all(program.command, "-", "_") + "_");
}

}  // namespace svdag
