#include "io/help/manual.h"
#include "streaming/error.h"

namespace svdag {
namespace {

using Fields = std::vector<std::string>;

std::string join(const Fields& words, char separator) {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : std::string(1, separator)) + word;
  return text;
}

Fields split(std::string_view text, char separator) {
  Fields found;
  if (text.empty()) return found;
  for (;;) {
    const size_t end = text.find(separator);
    found.emplace_back(text.substr(0, end));
    if (end == text.npos) return found;
    text.remove_prefix(end + 1);
  }
}

// The table row of an option; option_of() reads the fields in the same order.
std::string row(const char* kind, const ManualOption& option) {
  Fields fields = {kind,
                   join(option.names, ' '),
                   option.value,
                   option.group,
                   join(option.choices, ' '),
                   join(option.endings, ' '),
                   option.required ? "required" : "",
                   option.repeated ? "repeated" : "",
                   option.text};
  std::string line;
  for (const std::string& field : fields) line += field + "\t";
  line.back() = '\n';
  return line;
}

ManualOption option_of(const Fields& row) {
  if (row.size() != 9) fail_usage("manual table: a row is not an option");
  ManualOption option;
  option.names = split(row[1], ' ');
  option.value = row[2];
  option.group = row[3];
  option.choices = split(row[4], ' ');
  option.endings = split(row[5], ' ');
  option.required = !row[6].empty();
  option.repeated = !row[7].empty();
  option.text = row[8];
  return option;
}

void write(const char* kind, const Manual& manual, std::string* table) {
  *table += std::string(kind) + "\t" + manual.command + "\t" + manual.text + "\n";
  for (const ManualOption& operand : manual.operands) *table += row("operand", operand);
  for (const ManualOption& option : manual.options) *table += row("option", option);
  for (const std::string& line : split(manual.notes, '\n')) *table += "note\t" + line + "\n";
  for (const Manual& command : manual.commands) write("command", command, table);
}

}  // namespace

std::string to_table(const Manual& manual) {
  std::string table;
  write("program", manual, &table);
  return table;
}

std::vector<Manual> from_table(std::string_view table) {
  std::vector<Manual> programs;
  Manual* command = nullptr;
  for (const std::string& line : split(table, '\n')) {
    if (line.empty()) continue;
    const Fields fields = split(line, '\t');
    const std::string& kind = fields[0];
    if (kind == "program" && fields.size() == 3) {
      command = &programs.emplace_back();
      command->command = fields[1], command->text = fields[2];
    } else if (command == nullptr) {
      fail_usage("manual table: does not begin with a program");
    } else if (kind == "command" && fields.size() == 3) {
      command = &programs.back().commands.emplace_back();
      command->command = fields[1], command->text = fields[2];
    } else if (kind == "operand") {
      command->operands.push_back(option_of(fields));
    } else if (kind == "option") {
      command->options.push_back(option_of(fields));
    } else if (kind == "note" && fields.size() <= 2) {
      if (!command->notes.empty()) command->notes += '\n';
      command->notes += fields.size() == 2 ? fields[1] : "";
    } else {
      fail_usage("manual table: unknown kind of row: " + kind);
    }
  }
  return programs;
}

}  // namespace svdag
