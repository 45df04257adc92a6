// Text to and from other programs.
#pragma once

#include <string>
#include <vector>

namespace svdag {

// `word` so that sh reads it as one word.
std::string shell_word(const std::string& word);
// All of `words`, with blanks between them.
std::string shell_words(const std::vector<std::string>& words);
// Lines joined by "; ".
std::string one_line(const std::string& text);
// The last line that is not empty.
std::string last_line_of(const std::string& text);

}  // namespace svdag
