// Parses the command line of every program with CLI11. --help is generated from the manual of the
// options; an error is one sentence, with a suggestion for a misspelt option.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/dag/graph/selection.h"
#include "io/help/manual.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace svdag {

// The manual of a program: its options and commands.
Manual manual_of(const CLI::App& program);

// Parses the words behind a program's name. --help and --version are thrown as CLI::Success; a
// wrong command line is an Error (kUsage).
void parse_words(CLI::App* program, const std::vector<std::string>& words);

// Parses the command line of a program. Returns the exit code if the program has nothing else to do
// (--help,
// --version). A wrong command line is an Error (kUsage).
std::optional<int> read_command_line(CLI::App* program, int argc, char** argv);

// Each of these declares the values of an option, for the manual and completions, and returns the
// option. takes_files() and takes_folder() reject only empty names, suggests() rejects nothing.
CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& choices);
CLI::Option* suggests(CLI::Option* option, const std::vector<std::string>& choices);
CLI::Option* takes_files(CLI::Option* option, const std::vector<std::string>& endings);
CLI::Option* takes_folder(CLI::Option* option);
CLI::Option* takes_whole_number(CLI::Option* option);               // of 64 bits
CLI::Option* from_to(CLI::Option* option, size_t min, size_t max);  // integers

// Adds -n, --no-clobber.
void add_no_clobber(CLI::App* command, bool* no_clobber);

// Adds -m, the memory budget of a command, with its help text. Less than 1M is an Error (kUsage).
void add_memory_budget(CLI::App* command, uint64_t* bytes,
                       const std::string& text = "Memory budget in bytes");

// Adds --layout.
void add_layout(CLI::App* command, Layout* layout);

// Adds --layer, --level and --bounds. Without `with_level`, the command has no --level, or another
// one.
void add_selection(CLI::App* command, Selection* selection, bool with_level = true);
// --up of a .vox: 0 to 2.
void add_vox_up(CLI::App* command, std::optional<int>* up);

// Adds --layer.
void add_layer(CLI::App* command, std::vector<std::string>* layers);

// Sets the notes of a command: `before`, examples (one command line each), and the exit codes.
void add_examples(CLI::App* command, const std::vector<std::string>& lines,
                  const std::string& before = "");

}  // namespace svdag
