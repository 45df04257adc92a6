#include "io/help/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <iterator>
#include <sstream>

#include "io/help/help_text.h"
#include "io/help/usage_error.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/process/terminal.h"

namespace svdag {
namespace {

// A hint is stored as CLI11's text of an option, which only its own help shows: one of these, and
// words.
constexpr const char* kChoices = "choices";
constexpr const char* kEndings = "endings";

constexpr uint64_t kMinMemory = 1 << 20;  // less does not suffice to read even small scenes

CLI::Option* hint(CLI::Option* option, std::string text, const std::vector<std::string>& words) {
  for (const std::string& word : words) text += " " + word;
  return option->option_text(text);
}

std::vector<std::string> hint_words(const CLI::Option& option, const std::string& kind) {
  std::istringstream text(option.get_option_text());
  std::vector<std::string> words{std::istream_iterator<std::string>(text), {}};
  if (words.empty() || words[0] != kind) return {};
  words.erase(words.begin());
  return words;
}

// Accepts only these numbers: CLI11 itself would read -1, and numbers that are too large, as
// 2^64 - 1.
CLI::Option* accept_numbers(CLI::Option* option, uint64_t min, uint64_t max,
                            const std::string& expected) {
  return option->check([=](const std::string& text) {
    uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, value);
    const bool valid = read.ec == std::errc() && read.ptr == end && value >= min && value <= max;
    return valid ? "" : "\"" + text + "\" is not a " + expected;
  });
}

std::string with_conditions(const CLI::Option& option) {
  std::string text = option.get_description();
  for (const CLI::Option* other : option.get_needs()) text += " (needs " + other->get_name() + ")";
  for (const CLI::Option* other : option.get_excludes())
    text += " (not with " + other->get_name() + ")";
  return text;
}

std::string heading_of(const CLI::App& group) {
  std::string name = group.get_group();
  if (group.get_require_option_min() == 1) name += " (exactly one is required)";
  return name;
}

// `heading` is "" for the command itself, whose options are in CLI11's group "Options".
ManualOption describe_option(const CLI::Option& option, const std::string& heading) {
  ManualOption described;
  for (const std::string& name : option.get_snames()) described.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) described.names.push_back("--" + name);
  if (option.get_positional()) described.names = {option.get_name(true)};
  const bool is_flag = option.get_items_expected_max() == 0;
  if (!is_flag && !option.get_positional()) described.value = option.get_type_name();
  described.text = with_conditions(option);
  described.group = !heading.empty()                  ? heading
                    : option.get_group() == "Options" ? ""
                                                      : option.get_group();
  described.choices = hint_words(option, kChoices);
  described.endings = hint_words(option, kEndings);
  described.required = option.get_required();
  described.repeated = option.get_items_expected_max() > 1 &&
                       (option.get_positional() || option.get_allow_extra_args());
  return described;
}

void describe_options(const CLI::App& app, const std::string& heading, Manual* manual) {
  for (const CLI::App* group : app.get_subcommands({})) {
    if (group->get_name().empty()) describe_options(*group, heading_of(*group), manual);
  }
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    if (!heading.empty() && option == app.get_help_ptr())
      continue;  // CLI11 adds one to every group
    ManualOption described = describe_option(*option, heading);
    (option->get_positional() ? manual->operands : manual->options).push_back(std::move(described));
  }
}

Manual describe(const CLI::App& app, const std::string& command) {
  Manual manual;
  manual.command = command;
  manual.text = app.get_description();
  manual.notes = app.get_footer();
  describe_options(app, "", &manual);
  for (const CLI::App* each : app.get_subcommands({})) {
    if (!each->get_name().empty())
      manual.commands.push_back(describe(*each, command + " " + each->get_name()));
  }
  return manual;
}

}  // namespace

Manual manual_of(const CLI::App& program) {
  return describe(program, program.get_name());
}

void parse_words(CLI::App* program, const std::vector<std::string>& words) {
  const Manual manual = manual_of(*program);
  const std::string problem = explain_words(manual, words);
  if (!problem.empty()) fail_usage(problem);
  try {
    program->parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::Success&) {
    throw;
  } catch (const CLI::ParseError& error) {
    fail_usage(plain_usage_error(error.what()) + "; see " + command_of(manual, words).command +
               " --help");
  }
}

std::optional<int> read_command_line(CLI::App* program, int argc, char** argv) {
  const Manual manual = manual_of(*program);
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words == std::vector<std::string>{kManualJson}) {
    std::fputs(manual_json(manual).c_str(), stdout);
    return 0;
  }
  // "help mesh" is "mesh --help" of a program with commands, of which none is "help".
  const bool is_help = !words.empty() && words[0] == "help" && !manual.commands.empty() &&
                       &command_of(manual, words) == &manual;
  if (is_help) {
    words.erase(words.begin());
    words.push_back("--help");
  }
  try {
    parse_words(program, words);
    return std::nullopt;
  } catch (const CLI::CallForHelp&) {
    std::fputs(help_text(command_of(manual, words), text_width(stdout)).c_str(), stdout);
    return 0;
  } catch (const CLI::Success& success) {  // --version
    return program->exit(success);
  }
}

CLI::Option* suggests(CLI::Option* option, const std::vector<std::string>& choices) {
  return hint(option, kChoices, choices);
}

CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& choices) {
  return suggests(option->check([choices](const std::string& value) {
    std::string list;
    for (const std::string& choice : choices) {
      if (choice == value) return std::string();
      list += (list.empty() ? "" : ", ") + choice;
    }
    return "\"" + value + "\" is not one of " + list;
  }),
                  choices);
}

CLI::Option* takes_files(CLI::Option* option, const std::vector<std::string>& endings) {
  // An empty name is a mistake, such as an unset variable in a script.
  const auto check = [](const std::string& name) {
    return name.empty() ? "the name is empty" : "";
  };
  return hint(option->check(check), kEndings, endings);
}

CLI::Option* takes_folder(CLI::Option* option) {
  return takes_files(option, {"/"});
}

CLI::Option* takes_whole_number(CLI::Option* option) {
  return accept_numbers(option, 0, UINT64_MAX, "whole number from 0 to 2^64 - 1");
}

CLI::Option* from_to(CLI::Option* option, size_t min, size_t max) {
  const std::string range = std::to_string(min) + " to " + std::to_string(max);
  std::string text = option->get_description();
  text.insert(std::min(text.find(" (default"), text.size()), ", " + range);
  return accept_numbers(option->description(text), min, max, "number from " + range);
}

void add_no_clobber(CLI::App* command, bool* no_clobber) {
  command->add_flag("-n,--no-clobber", *no_clobber, "Do not replace an existing output");
}

void add_memory_budget(CLI::App* command, uint64_t* bytes, const std::string& text) {
  const auto read = [bytes](const std::string& value) {
    *bytes = parse_count(value, "--memory");
    if (*bytes < kMinMemory)
      fail_usage("--memory: " + value + " is less than 1M: give a size such as 512M or 4G");
  };
  command
      ->add_option_function<std::string>("-m,--memory", read,
                                         text + ", for example 4G (default: half of the machine)")
      ->type_name("SIZE");
}

void add_layout(CLI::App* command, Layout* layout) {
  const auto read = [layout](const std::string& name) {
    for (const Layout known : {Layout::kPlain, Layout::kCompact}) {
      if (name == layout_name(known)) return void(*layout = known);
    }
    fail_usage("--layout: unknown layout \"" + name + "\": choose plain or compact");
  };
  suggests(command->add_option_function<std::string>(
               "--layout", read,
               "plain (default), or compact: less than half the bytes, traced almost as fast"),
           {"plain", "compact"})
      ->type_name("LAYOUT");
}

void add_layer(CLI::App* command, std::vector<std::string>* layers) {
  command
      ->add_option("--layer", *layers,
                   "Only this layer (svdag info --layers lists them); may be repeated")
      ->allow_extra_args(false)
      ->type_name("NAME");
}

void add_selection(CLI::App* command, Selection* selection, bool with_level) {
  add_layer(command, &selection->layers);
  if (with_level)
    command
        ->add_option("--level", selection->level,
                     "Coarsen to 2^K voxels a side: a voxel is set if it holds a set voxel")
        ->type_name("K");
  command
      ->add_option_function<std::string>(
          "--bounds", [selection](const std::string& s) { selection->bounds = parse_bounds(s); },
          "Only the voxels in this box, in world units")
      ->type_name("x0,y0,z0,x1,y1,z1");
}

void add_examples(CLI::App* command, const std::vector<std::string>& lines,
                  const std::string& before) {
  std::string notes = before + (before.empty() ? "" : "\n\n");
  notes += lines.size() == 1 ? "Example:\n" : "Examples:\n";
  for (const std::string& line : lines) notes += "  " + line + "\n";
  command->footer(notes + "\n" + kExitCodes);
}

}  // namespace svdag
