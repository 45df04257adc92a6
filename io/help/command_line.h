// The command line of every program, parsed by CLI11: --help from the manual of its options, errors
// as one sentence, with the option that a typo resembles.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/help/manual.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace svdag {

// The manual of a program: its options and commands.
Manual manual_of(const CLI::App& program);

// Parses a command line; returns the exit code if nothing else is to be done (--help, --version).
// Error: kUsage.
std::optional<int> read_command_line(CLI::App* program, int argc, char** argv);

// Hints for the manual about an option's values that CLI11 does not know. Each returns the option.
CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& choices);  // and no other
CLI::Option* suggests(CLI::Option* option, const std::vector<std::string>& choices);
CLI::Option* takes_files(CLI::Option* option, const std::vector<std::string>& endings);
CLI::Option* takes_folder(CLI::Option* option);
CLI::Option* takes_whole_number(CLI::Option* option);               // of 64 bits
CLI::Option* from_to(CLI::Option* option, size_t min, size_t max);  // whole numbers

// -n, --no-clobber.
void add_no_clobber(CLI::App* command, bool* no_clobber);

// -m, the memory budget of a command, with the text of its help; less than 1M is an Error (kUsage).
void add_memory_budget(CLI::App* command, uint64_t* bytes,
                       const std::string& text = "Memory budget in bytes");

// The notes of a command: `before`, examples (one command each), and the exit codes.
void add_examples(CLI::App* command, const std::vector<std::string>& lines,
                  const std::string& before = "");

extern const std::vector<std::string> kSceneEndings;

}  // namespace svdag
