// Completion of command lines by shells: commands, options, the values that have names, and files
// by their endings.
//
// Every script holds all it needs, so that it may be sourced as well as found; the words of a
// command come from its manual, so none is listed twice.
#pragma once

#include "io/help/manual.h"

namespace svdag {

// A script for bash 4 or later, of one program.
std::string bash_completion(const Manual& program);

// One function _svdag for all programs.
std::string zsh_completion(const std::vector<Manual>& programs);

// A script for fish 3, of one program.
std::string fish_completion(const Manual& program);

// Whether an option takes folders alone, or files of any name.
bool takes_folders(const ManualOption& option);
bool takes_any_file(const ManualOption& option);

// "build" of "svdag build"; "" for the program itself.
std::string name_in_program(const Manual& command);

// '...' for a shell, which does not expand its content.
std::string quoted(const std::string& text);

std::string words(const std::vector<std::string>& all);

// `text` with `to` in every place of `from`.
std::string with(std::string text, const std::string& from, const std::string& to);

}  // namespace svdag
