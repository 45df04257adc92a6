// The manual of a command: the one source of --help, man pages and completions.
//
// A program builds its manual from the options that it parses (command_line.h); --help formats it
// for the width of a terminal (help_text.h). Man pages and completions are written at build time:
// each program prints its manual as JSON when it is called with kManualJson, and a script
// (pages/write_pages.py) reads them. Parsing the text of --help, as help2man does, would lose which
// values and files an option takes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace svdag {

// The hidden argument that makes a program print its manual as JSON.
inline constexpr const char* kManualJson = "--manual-json";

// The last paragraph of the notes of every command.
inline constexpr const char* kExitCodes =
    "Exit codes: 0 ok, 1 differs, 2 usage, 3 bad input, 4 disk or output, 5 memory limit, 128 + n "
    "stopped by signal n.";

struct ManualOption {
  std::vector<std::string> names;    // "-r", "--resolution"; one name for an operand
  std::string value;                 // placeholder of the value; "" for a flag
  std::string text;                  // description, with units, range and default
  std::string group;                 // heading; "" for the default heading
  std::vector<std::string> choices;  // named values, if it takes only these
  std::vector<std::string> endings;  // file name extensions; "/": folders, "*": any file
  bool required = false;
  bool repeated = false;  // takes several values
};

struct Manual {
  std::string command;  // "svdag build"
  std::string text;     // description
  std::vector<ManualOption> operands, options;
  std::string notes;             // printed after the options; see paragraphs_of()
  std::vector<Manual> commands;  // subcommands of a program
};

// "-o OUT [OPTIONS] SCENE...": what follows the command's name.
std::string usage_of(const Manual& manual);

// A paragraph of notes or topics. Indented lines are preformatted; other lines are text to be
// filled. A line of a few words and a colon ("Examples:") at the start of a paragraph is a heading.
struct Paragraph {
  enum class Kind { kHeading, kText, kLines };
  Kind kind;
  std::vector<std::string> lines;  // kText: one line, unbroken; kHeading: without the colon
};
std::vector<Paragraph> paragraphs_of(std::string_view text);

// The manual as JSON, with usage_of() each command.
std::string manual_json(const Manual& manual);

}  // namespace svdag
