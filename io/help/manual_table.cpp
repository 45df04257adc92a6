#include "io/help/manual.h"
#include "streaming/error.h"

namespace svdag {
namespace {

using Fields = std::vector<std::string>;

std::string joined(const Fields& words, char between) {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : std::string(1, between)) + word;
  return text;
}

Fields parts(std::string_view text, char between) {
  Fields found;
  if (text.empty()) return found;
  for (;;) {
    const size_t end = text.find(between);
    found.emplace_back(text.substr(0, end));
    if (end == text.npos) return found;
    text.remove_prefix(end + 1);
  }
}

// The fields of an option, which from_table() reads in the same order.
std::string row(const char* kind, const ManualOption& option) {
  Fields fields = {kind,
                   joined(option.names, ' '),
                   option.value,
                   option.group,
                   joined(option.choices, ' '),
                   joined(option.endings, ' '),
                   option.required ? "required" : "",
                   option.repeated ? "repeated" : "",
                   option.text};
  std::string line;
  for (const std::string& field : fields) line += field + "\t";
  line.back() = '\n';
  return line;
}

ManualOption option_of(const Fields& row) {
  if (row.size() != 9) fail_usage("the table of a manual has a row that is not an option");
  ManualOption option;
  option.names = parts(row[1], ' ');
  option.value = row[2];
  option.group = row[3];
  option.choices = parts(row[4], ' ');
  option.endings = parts(row[5], ' ');
  option.required = !row[6].empty();
  option.repeated = !row[7].empty();
  option.text = row[8];
  return option;
}

void write(const char* kind, const Manual& manual, std::string* table) {
  *table += std::string(kind) + "\t" + manual.command + "\t" + manual.text + "\n";
  for (const ManualOption& operand : manual.operands) *table += row("operand", operand);
  for (const ManualOption& option : manual.options) *table += row("option", option);
  for (const std::string& line : parts(manual.notes, '\n')) *table += "note\t" + line + "\n";
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
  for (const std::string& line : parts(table, '\n')) {
    if (line.empty()) continue;
    const Fields fields = parts(line, '\t');
    const std::string& kind = fields[0];
    if (kind == "program" && fields.size() == 3) {
      command = &programs.emplace_back();
      command->command = fields[1], command->text = fields[2];
    } else if (command == nullptr) {
      fail_usage("the table of a manual does not begin with a program");
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
      fail_usage("the table of a manual has a row of an unknown kind: " + kind);
    }
  }
  return programs;
}

}  // namespace svdag
