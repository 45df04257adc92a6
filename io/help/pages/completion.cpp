#include "io/help/pages/completion.h"

namespace svdag {

bool takes_folders(const ManualOption& option) {
  return option.endings == std::vector<std::string>{"/"};
}

bool takes_any_file(const ManualOption& option) {
  return option.endings == std::vector<std::string>{"*"};
}

std::string name_in_program(const Manual& command) {
  const size_t space = command.command.find(' ');
  return space == std::string::npos ? "" : command.command.substr(space + 1);
}

std::string single_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string join_words(const std::vector<std::string>& all) {
  std::string out;
  for (const std::string& word : all) out += (out.empty() ? "" : " ") + word;
  return out;
}

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace svdag
