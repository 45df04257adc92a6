#include "io/help/help_text.h"

namespace svdag {
namespace {

constexpr size_t kTextColumn = 28;         // column of the texts of options
constexpr size_t kMinTwoColumnWidth = 70;  // in a narrower terminal, texts are below the names

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text) {
    if (c != ' ') {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  if (!word.empty()) words.push_back(std::move(word));
  return words;
}

// Breaks words into lines of at most `width` columns. The first line begins at column `at`, the
// others with `indent`. Each line except the last ends with `line_end`.
std::string fill(const std::vector<std::string>& words, size_t at, const std::string& indent,
                 size_t width, const char* line_end = "") {
  const size_t reserve = std::string_view(line_end).size();
  std::string out;
  size_t column = at;
  bool first = true;
  for (const std::string& word : words) {
    if (!first && column + 1 + word.size() + reserve > width) {
      out += line_end + ("\n" + indent);
      column = indent.size();
    } else if (!first) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
    first = false;
  }
  return out;
}

std::string fill(std::string_view text, size_t at, const std::string& indent, size_t width) {
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

std::string indentation(size_t columns) {
  return std::string(columns, ' ');
}

// Where the second column of a table row begins; 0 if it has none.
size_t second_column(const std::string& line, size_t indent) {
  const size_t gap = line.find("  ", indent);
  return gap == line.npos ? 0 : line.find_first_not_of(' ', gap);
}

// A preformatted line. Commands and table rows that exceed `width` are broken, other lines are not.
std::string preformatted(const std::string& line, size_t width) {
  const size_t indent = line.find_first_not_of(' ');
  if (line.size() <= width) return line + "\n";
  if (line.compare(indent, 5, "svdag") == 0) {
    const std::vector<std::string> words = with_values(words_of(line), width - indent - 4);
    return indentation(indent) + fill(words, indent, indentation(indent + 2), width, " \\") + "\n";
  }
  const size_t column = second_column(line, indent);
  if (column == 0 || column > width / 2) return line + "\n";
  return line.substr(0, column) + fill(line.substr(column), column, indentation(column), width) +
         "\n";
}

std::string name_and_text(const std::string& title, const std::string& text, size_t width) {
  const bool beside = width >= kMinTwoColumnWidth;
  const size_t column = beside ? kTextColumn : 6;
  std::string out = "  " + fill(title, 2, indentation(4), width);
  if (beside && out.size() + 2 <= column)
    out += indentation(column - out.size());
  else
    out += "\n" + indentation(column);
  return out + fill(text, column, indentation(column), width) + "\n";
}

// Options by heading; those without one are under "Options".
std::string options_text(const std::vector<ManualOption>& options, size_t width) {
  std::string out;
  for (const std::string& group : groups_of(options)) {
    out += "\n" + (group.empty() ? std::string("Options") : group) + ":\n";
    for (const ManualOption& option : options) {
      if (option.group == group) out += name_and_text(title_of(option), option.text, width);
    }
  }
  return out;
}

}  // namespace

std::string title_of(const ManualOption& option) {
  std::string title;
  for (const std::string& name : option.names) title += (title.empty() ? "" : ", ") + name;
  if (!option.value.empty()) title += " " + option.value;
  return title + (option.repeated ? "..." : "");
}

std::string fill_paragraphs(std::string_view text, size_t width) {
  std::string out;
  bool separate = false;
  for (const Paragraph& paragraph : paragraphs_of(text)) {
    if (separate) out += '\n';
    separate = paragraph.kind != Paragraph::Kind::kHeading;
    if (paragraph.kind == Paragraph::Kind::kHeading) out += paragraph.lines[0] + ":\n";
    if (paragraph.kind == Paragraph::Kind::kText)
      out += fill(paragraph.lines[0], 0, "", width) + "\n";
    if (paragraph.kind != Paragraph::Kind::kLines) continue;
    for (const std::string& line : paragraph.lines) out += preformatted(line, width);
  }
  return out;
}

std::string help_text(const Manual& manual, size_t width) {
  std::string out = fill(manual.text, 0, "", width) + "\n";
  out += fill("Usage: " + manual.command + " " + usage_of(manual), 0, indentation(4), width) + "\n";
  if (!manual.commands.empty()) {
    out += "\nCommands:\n";
    for (const Manual& command : manual.commands)
      out +=
          name_and_text(command.command.substr(command.command.find(' ') + 1), command.text, width);
  }
  if (!manual.operands.empty()) {
    out += "\nArguments:\n";
    for (const ManualOption& operand : manual.operands)
      out += name_and_text(title_of(operand), operand.text, width);
  }
  out += options_text(manual.options, width);
  if (!manual.notes.empty()) out += "\n" + fill_paragraphs(manual.notes, width);
  return out;
}

}  // namespace svdag
