#include "streaming/process/shell.h"

#include <sstream>

namespace svdag {

std::string shell_word(const std::string& word) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
  // As the first word of a command "a=b" would be an assignment. An option never is the first word.
  const bool assigns = !word.starts_with('-') && word.find('=') != std::string::npos;
  const bool plain = word.find_first_not_of(kPlain) == std::string::npos;
  if (!word.empty() && plain && !assigns) return word;
  std::string quoted = "'";
  for (const char c : word) c == '\'' ? quoted += "'\\''" : quoted += c;
  return quoted + "'";
}

std::string shell_words(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

std::string one_line(const std::string& text) {
  std::istringstream lines(text);
  std::string joined, line;
  while (std::getline(lines, line)) {
    if (!line.empty()) joined += (joined.empty() ? "" : "; ") + line;
  }
  return joined;
}

std::string last_line_of(const std::string& text) {
  std::istringstream lines(text);
  std::string last, line;
  while (std::getline(lines, line)) {
    if (!line.empty()) last = line;
  }
  return last;
}

}  // namespace svdag
