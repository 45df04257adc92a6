#include "io/help/help_text.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <utility>

namespace svdag {
namespace {

constexpr size_t kTextColumn = 28;         // column of the texts of options
constexpr size_t kMinTwoColumnWidth = 70;  // in a narrower terminal, texts are below the names

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

// Breaks words into lines of at most `width` columns. The first line begins at column `at`, the
// others with `indent`. Each line except the last ends with `line_end`.
std::string fill(const std::vector<std::string>& words, size_t at, size_t indent, size_t width,
                 const std::string& line_end = "") {
  std::string out;
  for (const std::string& word : words) {
    const bool first = out.empty();
    at += word.size() + (first ? 0 : 1);
    if (!first && at + line_end.size() > width) {
      out += line_end + "\n" + std::string(indent, ' ');
      at = indent + word.size();
    } else if (!first) {
      out += ' ';
    }
    out += word;
  }
  return out;
}

std::string fill(const std::string& text, size_t at, size_t indent, size_t width) {
  return fill(words_of(text), at, indent, width);
}

// The words of a command line, with each option and its value joined if they fit `max_length`.
std::vector<std::string> with_values(const std::vector<std::string>& words, size_t max_length) {
  std::vector<std::string> out;
  bool open = false;  // the last word is an option that may have a value
  for (const std::string& word : words) {
    const bool is_option = word[0] == '-' && word != "--";
    if (open && !is_option && word != "--" && out.back().size() + 1 + word.size() <= max_length)
      out.back() += " " + word;
    else
      out.push_back(word);
    open = is_option && word.find('=') == word.npos;
  }
  return out;
}

// A preformatted line. Commands and table rows that exceed `width` are broken, other lines are not.
std::string preformatted(const std::string& line, size_t width) {
  const size_t indent = line.find_first_not_of(' ');
  if (line.size() <= width) return line + "\n";
  if (line.compare(indent, 5, "svdag") == 0) {
    const std::vector<std::string> words = with_values(words_of(line), width - indent - 4);
    return line.substr(0, indent) + fill(words, indent, indent + 2, width, " \\") + "\n";
  }
  const size_t gap = line.find("  ", indent), column = line.find_first_not_of(' ', gap);
  if (gap == line.npos || column > width / 2) return line + "\n";
  return line.substr(0, column) + fill(line.substr(column), column, column, width) + "\n";
}

std::string name_and_text(const std::string& title, const std::string& text, size_t width) {
  const bool beside = width >= kMinTwoColumnWidth;
  const size_t column = beside ? kTextColumn : 6;
  std::string out = "  " + fill(title, 2, 4, width);
  out += beside && out.size() + 2 <= column ? std::string(column - out.size(), ' ')
                                            : "\n" + std::string(column, ' ');
  return out + fill(text, column, column, width) + "\n";
}

// "-r, --resolution N": an option with all its names, or an operand.
std::string title_of(const ManualOption& option) {
  std::string title;
  for (const std::string& name : option.names) title += (title.empty() ? "" : ", ") + name;
  if (!option.value.empty()) title += " " + option.value;
  return title + (option.repeated ? "..." : "");
}

// The options of each heading, in order of first appearance.
std::string options_text(const std::vector<ManualOption>& options, size_t width) {
  std::vector<std::pair<std::string, std::string>> groups;
  for (const ManualOption& option : options) {
    auto group = std::ranges::find(groups, option.group, [](const auto& g) { return g.first; });
    if (group == groups.end()) group = groups.insert(group, {option.group, ""});
    group->second += name_and_text(title_of(option), option.text, width);
  }
  std::string out;
  for (const auto& [name, text] : groups)
    out += "\n" + (name.empty() ? "Options" : name) + ":\n" + text;
  return out;
}

}  // namespace

std::string fill_paragraphs(std::string_view text, size_t width) {
  std::string out;
  bool separate = false;
  for (const auto& [kind, lines] : paragraphs_of(text)) {
    if (separate) out += '\n';
    separate = kind != Paragraph::Kind::kHeading;
    if (kind == Paragraph::Kind::kHeading) out += lines[0] + ":\n";
    if (kind == Paragraph::Kind::kText) out += fill(lines[0], 0, 0, width) + "\n";
    if (kind != Paragraph::Kind::kLines) continue;
    for (const std::string& line : lines) out += preformatted(line, width);
  }
  return out;
}

std::string help_text(const Manual& manual, size_t width) {
  std::string out = fill(manual.text, 0, 0, width) + "\n";
  out += fill("Usage: " + manual.command + " " + usage_of(manual), 0, 4, width) + "\n";
  if (!manual.commands.empty()) out += "\nCommands:\n";
  for (const Manual& command : manual.commands)
    out += name_and_text(command.command.substr(manual.command.size() + 1), command.text, width);
  if (!manual.operands.empty()) out += "\nArguments:\n";
  for (const ManualOption& operand : manual.operands)
    out += name_and_text(title_of(operand), operand.text, width);
  out += options_text(manual.options, width);
  if (!manual.notes.empty()) out += "\n" + fill_paragraphs(manual.notes, width);
  return out;
}

}  // namespace svdag
