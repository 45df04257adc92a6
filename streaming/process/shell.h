// Command lines for sh, and the output of other programs.
#pragma once

#include <string>
#include <vector>

namespace svdag {

// Quotes `word`, where necessary, so that sh reads it as one word.
std::string shell_word(const std::string& word);
// All of `words`, quoted and separated by spaces.
std::string shell_words(const std::vector<std::string>& words);
// The non-empty lines of `text`, joined by "; ".
std::string one_line(const std::string& text);
// The last non-empty line of `text`; empty if there is none.
std::string last_line_of(const std::string& text);

}  // namespace svdag
