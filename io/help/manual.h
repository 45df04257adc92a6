// What a program says about a command: the one source of --help, man pages and completions.
//
// Programs make it of the options that they parse (command_line.h), never apart from them; --help
// is its text at the width of a terminal (help_text.h). Pages and completions are written when
// the project is built: every program prints its manual as a table when it is called with
// kManualTable, and svdag-manual (io/help/pages) reads the tables. So no program carries a writer
// of roff, and none must link another to tell about its options. Reading the text of --help back,
// as help2man does, would lose which values and which files an option takes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace svdag {

// The hidden argument for which a program prints its manual.
inline constexpr const char* kManualTable = "--manual-table";

// The last of the notes of every command.
inline constexpr const char* kExitCodes =
    "Exit codes: 0 ok, 1 differs, 2 usage, 3 bad input, 4 disk or output, 5 memory limit, 128 + n "
    "stopped by signal n.";

struct ManualOption {
  std::vector<std::string> names;    // "-r", "--resolution"; of an operand: its one name
  std::string value;                 // what its value is called; "" for a flag
  std::string text;                  // what it does, with units, range and default
  std::string group;                 // its heading; "" for that of most
  std::vector<std::string> choices;  // the values it takes, if they have names
  std::vector<std::string> endings;  // the files it takes: ".ply"; "/": folders, "*": any
  bool required = false;
  bool repeated = false;  // takes several values
};

struct Manual {
  std::string command;  // "svdag build"
  std::string text;     // what it does
  std::vector<ManualOption> operands, options;
  std::string notes;             // behind the options: see paragraphs_of()
  std::vector<Manual> commands;  // what the program is split into
};

// The headings of options, in the order in which they appear first.
std::vector<std::string> groups_of(const std::vector<ManualOption>& options);

// "svdag-build": the name of a command's page.
std::string page_of(const std::string& command);

// "-o OUT [OPTIONS] SCENE...": what follows the command's name.
std::string usage_of(const Manual& manual);

// The paragraphs of notes and topics. Indented lines stay as they are; others are one text, to be
// filled. A text of one word and a colon ("Examples:") is the heading of what follows.
struct Paragraph {
  enum class Kind { kHeading, kText, kLines };
  Kind kind;
  std::vector<std::string> lines;  // of kText one, without line breaks; of kHeading no colon
};
std::vector<Paragraph> paragraphs_of(std::string_view text);

// The table: a line per command, option and line of notes, with tabs between its fields.
std::string to_table(const Manual& manual);
// The programs of a table. One that to_table() has not written is an Error (kUsage).
std::vector<Manual> from_table(std::string_view table);

}  // namespace svdag
