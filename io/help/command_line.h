// A command line read by CLI11, as every program with that library reads it: --help from the
// manual of its options, errors as one sentence, with what a typo was meant to be.
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

// What the options of a program say, its commands included.
Manual manual_of(const CLI::App& program);

// Reads a command line; the exit code if there is nothing else to do (--help, --version). What
// cannot be meant is an Error (kUsage).
std::optional<int> read_command_line(CLI::App* program, int argc, char** argv);

// What the manual tells about the values of an option, beside what CLI11 knows. Each returns it.
CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& choices);  // and no other
CLI::Option* suggests(CLI::Option* option, const std::vector<std::string>& choices);
CLI::Option* takes_files(CLI::Option* option, const std::vector<std::string>& endings);
CLI::Option* takes_folder(CLI::Option* option);
CLI::Option* takes_whole_number(CLI::Option* option);                  // of 64 bits
CLI::Option* from_to(CLI::Option* option, size_t least, size_t most);  // whole numbers

// -m, the memory budget of a command, with the text of its help; less than 1M is an Error (kUsage).
void add_memory_budget(CLI::App* command, uint64_t* bytes,
                       const std::string& text = "Memory budget in bytes");

// The notes of a command: what there is to say, examples, a command each, and the exit codes.
void add_examples(CLI::App* command, const std::vector<std::string>& lines,
                  const std::string& before = "");

extern const std::vector<std::string> kSceneEndings;

}  // namespace svdag
