// Text to and from other programs.
#pragma once

#include <string>

namespace svdag {

// `word` so that sh reads it as one word.
std::string shell_word(const std::string& word);
// Lines joined by "; ".
std::string one_line(const std::string& text);
// The last line that is not empty.
std::string last_line_of(const std::string& text);

}  // namespace svdag
