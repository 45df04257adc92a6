#include "io/help/help_text.h"

namespace svdag {
namespace {

constexpr size_t kColumn = 28;  // of the texts of options
constexpr size_t kRoom = 70;    // columns from which on there is room for it

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

// Words in lines of at most `width` columns; the first one begins at the column `at`, the others
// with `indent`. Each but the last ends with `line_end`.
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

// The words of a command, options together with what follows them where that fits into `room`.
std::vector<std::string> with_values(const std::vector<std::string>& words, size_t room) {
  std::vector<std::string> out;
  bool open = false;  // the last word is an option that may have a value
  for (const std::string& word : words) {
    const bool is_option = word[0] == '-' && word != "--";
    if (open && !is_option && word != "--" && out.back().size() + 1 + word.size() <= room)
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

// Where the second column of a line of a table begins; 0 if it has none.
size_t second_column(const std::string& line, size_t indent) {
  const size_t gap = line.find("  ", indent);
  return gap == line.npos ? 0 : line.find_first_not_of(' ', gap);
}

// A line that keeps its shape, unless it is a command or a row too long for the terminal.
std::string kept(const std::string& line, size_t width) {
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

std::string entry(const std::string& title, const std::string& text, size_t width) {
  const bool beside = width >= kRoom;
  const size_t column = beside ? kColumn : 6;
  std::string out = "  " + fill(title, 2, indentation(4), width);
  if (beside && out.size() + 2 <= column)
    out += indentation(column - out.size());
  else
    out += "\n" + indentation(column);
  return out + fill(text, column, indentation(column), width) + "\n";
}

// Options by their headings; those of none are just options.
std::string options_text(const std::vector<ManualOption>& options, size_t width) {
  std::string out;
  for (const std::string& group : groups_of(options)) {
    out += "\n" + (group.empty() ? std::string("Options") : group) + ":\n";
    for (const ManualOption& option : options) {
      if (option.group == group) out += entry(title_of(option), option.text, width);
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

std::string filled(std::string_view text, size_t width) {
  std::string out;
  bool apart = false;
  for (const Paragraph& paragraph : paragraphs_of(text)) {
    if (apart) out += '\n';
    apart = paragraph.kind != Paragraph::Kind::kHeading;
    if (paragraph.kind == Paragraph::Kind::kHeading) out += paragraph.lines[0] + ":\n";
    if (paragraph.kind == Paragraph::Kind::kText)
      out += fill(paragraph.lines[0], 0, "", width) + "\n";
    if (paragraph.kind != Paragraph::Kind::kLines) continue;
    for (const std::string& line : paragraph.lines) out += kept(line, width);
  }
  return out;
}

std::string help_text(const Manual& manual, size_t width) {
  std::string out = fill(manual.text, 0, "", width) + "\n";
  out += fill("Usage: " + manual.command + " " + usage_of(manual), 0, indentation(4), width) + "\n";
  if (!manual.commands.empty()) {
    out += "\nCommands:\n";
    for (const Manual& command : manual.commands)
      out += entry(command.command.substr(command.command.find(' ') + 1), command.text, width);
  }
  if (!manual.operands.empty()) {
    out += "\nArguments:\n";
    for (const ManualOption& operand : manual.operands)
      out += entry(title_of(operand), operand.text, width);
  }
  out += options_text(manual.options, width);
  if (!manual.notes.empty()) out += "\n" + filled(manual.notes, width);
  return out;
}

}  // namespace svdag
