#include "io/help/manual.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

namespace svdag {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ManualOption, names, value, text, group, choices, endings,
                                   required, repeated)

namespace {

bool is_heading(const std::string& line) {
  return std::isupper(static_cast<unsigned char>(line[0])) && line.back() == ':' &&
         line.size() < 32 && std::all_of(line.begin(), line.end() - 1, [](char c) {
           return c == ' ' || std::isalpha(static_cast<unsigned char>(c));
         });
}

nlohmann::json json_of(const Manual& manual) {
  nlohmann::json json = {{"command", manual.command},          {"text", manual.text},
                         {"usage", usage_of(manual)},          {"notes", manual.notes},
                         {"operands", manual.operands},        {"options", manual.options},
                         {"commands", nlohmann::json::array()}};
  for (const Manual& command : manual.commands) json["commands"].push_back(json_of(command));
  return json;
}

}  // namespace

std::string usage_of(const Manual& manual) {
  if (!manual.commands.empty()) return "COMMAND [OPTIONS]";
  std::string usage;
  for (const ManualOption& option : manual.options) {
    if (option.required) usage += option.names.front() + " " + option.value + " ";
  }
  usage += "[OPTIONS]";
  for (const ManualOption& operand : manual.operands) {
    const std::string name = operand.names.front() + (operand.repeated ? "..." : "");
    usage += operand.required ? " " + name : " [" + name + "]";
  }
  return usage;
}

std::vector<Paragraph> paragraphs_of(std::string_view text) {
  std::vector<Paragraph> paragraphs;
  bool starts_paragraph = true;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty()) {
      starts_paragraph = true;
      continue;
    }
    const auto kind = line[0] == ' '                         ? Paragraph::Kind::kLines
                      : starts_paragraph && is_heading(line) ? Paragraph::Kind::kHeading
                                                             : Paragraph::Kind::kText;
    if (starts_paragraph || paragraphs.back().kind != kind) {
      paragraphs.push_back({kind, {line}});
    } else if (kind == Paragraph::Kind::kText) {
      paragraphs.back().lines[0] += " " + line;
    } else {
      paragraphs.back().lines.push_back(line);
    }
    if (kind == Paragraph::Kind::kHeading) paragraphs.back().lines[0].pop_back();
    starts_paragraph = false;
  }
  return paragraphs;
}

std::string manual_json(const Manual& manual) {
  return json_of(manual).dump(1) + "\n";
}

}  // namespace svdag
