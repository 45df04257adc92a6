#include "io/help/pages/man_page.h"

#include <algorithm>
#include <cctype>

namespace svdag {
namespace {

// Escapes text for troff: a minus that can be copied, straight quotes, and no line that begins like
// a macro.
std::string roff(std::string_view text) {
  std::string out = text.substr(0, 1) == "." ? "\\&" : "";
  for (const char c : text) {
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '"':
        out += "\\(dq";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      case '`':
        out += "\\(ga";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string upper(std::string text) {
  for (char& c : text) c = char(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string bold(std::string_view text) {
  return "\\fB" + roff(text) + "\\fR";
}
std::string italic(std::string_view text) {
  return "\\fI" + roff(text) + "\\fR";
}

std::string heading(const std::string& title) {
  return ".SH \"" + roff(upper(title)) + "\"\n";
}

std::string start(const std::string& page, int section, const std::string& what,
                  const PageConfig& config) {
  std::string lower = what;
  if (!lower.empty()) lower[0] = char(std::tolower(static_cast<unsigned char>(lower[0])));
  if (!lower.empty() && lower.back() == '.') lower.pop_back();
  return ".TH \"" + roff(upper(page)) + "\" " + std::to_string(section) + " \"\" \"" +
         roff(config.version) + "\" \"svdag manual\"\n" + heading("Name") + roff(page) + " \\- " +
         roff(lower) + "\n";
}

std::string option_entry(const ManualOption& option) {
  std::string title;
  for (const std::string& name : option.names) {
    if (!title.empty()) title += ", ";
    title += name[0] == '-' ? bold(name) : italic(name);
  }
  if (!option.value.empty()) title += " " + italic(option.value);
  if (option.repeated) title += "...";
  return ".TP\n" + title + "\n" + roff(option.text) + "\n";
}

std::string options(const std::vector<ManualOption>& all) {
  std::string out;
  for (const std::string& group : groups_of(all)) {
    out += heading(group.empty() ? "Options" : group);
    for (const ManualOption& option : all) {
      if (option.group == group) out += option_entry(option);
    }
  }
  return out;
}

std::string verbatim(const std::vector<std::string>& lines) {
  const size_t indent = lines[0].find_first_not_of(' ');
  std::string out = ".PP\n.RS 4\n.nf\n";
  for (const std::string& line : lines)
    out += roff(line.substr(std::min(indent, line.find_first_not_of(' ')))) + "\n";
  return out + ".fi\n.RE\n";
}

// The paragraphs of notes or a topic. Those before the first heading belong to `section`.
std::string body(std::string_view text, std::string section) {
  constexpr std::string_view kExit = "Exit codes: ";
  std::string out;
  const auto enter = [&](const std::string& title) {
    if (section == title) return;
    section = title;
    out += heading(title);
  };
  bool headed = false;
  for (const Paragraph& paragraph : paragraphs_of(text)) {
    const std::string& line = paragraph.lines[0];
    if (paragraph.kind == Paragraph::Kind::kHeading) {
      enter(line == "Example" ? "Examples" : line);
      headed = true;
    } else if (paragraph.kind == Paragraph::Kind::kLines) {
      out += verbatim(paragraph.lines);
    } else if (line.compare(0, kExit.size(), kExit) == 0) {
      enter("Exit status");
      out += roff(line.substr(kExit.size())) + "\n";
    } else {
      if (headed || section.empty()) enter("Notes");
      out += ".PP\n" + roff(line) + "\n";
    }
  }
  return out;
}

std::string see_also(const PageConfig& config) {
  std::string out = heading("See also");
  for (const std::string& page : config.see_also) {
    const size_t at = page.find('(');
    out += ".BR " + roff(page.substr(0, at)) + " " + page.substr(at) +
           (page == config.see_also.back() ? "\n" : ",\n");
  }
  return out;
}

}  // namespace

std::string topic_name(std::string_view text) {
  return std::string(text.substr(0, text.find(':')));
}

std::string command_page(const Manual& manual, const PageConfig& config) {
  std::string out = start(page_of(manual.command), 1, manual.text, config);
  out += heading("Synopsis") + bold(manual.command) + " " + roff(usage_of(manual)) + "\n";
  out += heading("Description") + roff(manual.text) + (manual.text.back() == '.' ? "\n" : ".\n");
  for (const ManualOption& operand : manual.operands) out += option_entry(operand);
  if (!manual.commands.empty()) out += heading("Commands");
  for (const Manual& command : manual.commands) {
    const std::string name = command.command.substr(command.command.find(' ') + 1);
    out += ".TP\n" + bold(name) + "\n" + roff(command.text) + "\n";
  }
  return out + options(manual.options) + body(manual.notes, "") + see_also(config);
}

std::string topic_page(std::string_view text, const PageConfig& config) {
  const size_t end = text.find('\n');
  const std::string name = topic_name(text);
  const std::string what(text.substr(name.size() + 2, end - name.size() - 2));
  return start("svdag-" + name, 7, what, config) + heading("Description") +
         body(text.substr(end), "Description") + see_also(config);
}

}  // namespace svdag
