// Suggestions for misspelt commands and options.
//
// Words are compared by their edit distance: the number of letters left out, added, changed or
// swapped with a neighbour (Damerau 1964; the restricted form, where no substring is edited twice).
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace svdag {

size_t edit_distance(std::string_view a, std::string_view b);

// The candidate nearest to `word`, the first of equals. If more than every third letter of `word`
// is wrong, the first that begins with it, or "".
std::string nearest(std::string_view word, std::span<const std::string> candidates);

// The command of another program of the project: "svdag-verify check" for "check", "svdag-verify"
// for "verify" or "svdag-verify"; "" for other words.
std::string command_of_other_program(const std::string& word);

}  // namespace svdag
