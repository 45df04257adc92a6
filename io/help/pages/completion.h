// Completion scripts for shells: they complete commands, options, named values, and files by name
// extension.
//
// The scripts are self-contained, so they can be sourced or installed in the shell's folder. All
// words come from the manuals.
#pragma once

#include "io/help/manual.h"

namespace svdag {

// The script of one program for bash 4 or later.
std::string bash_completion(const Manual& program);

// The script of all programs for zsh: one function _svdag.
std::string zsh_completion(const std::vector<Manual>& programs);

// The script of one program for fish 3.
std::string fish_completion(const Manual& program);

// Whether an option takes only folders, or any file.
bool takes_folders(const ManualOption& option);
bool takes_any_file(const ManualOption& option);

// "build" of "svdag build"; "" for the program itself.
std::string name_in_program(const Manual& command);

// `text` in single quotes, for sh.
std::string single_quoted(const std::string& text);

// The words, separated by spaces.
std::string join_words(const std::vector<std::string>& all);

// `text` with every `from` replaced by `to`.
std::string replace_all(std::string text, const std::string& from, const std::string& to);

}  // namespace svdag
