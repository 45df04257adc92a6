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

// `heading` is "" for the command itself, whose options are in CLI11's group "Options".
ManualOption describe_option(const CLI::Option& option, const std::string& heading) {
  ManualOption described;
  for (const std::string& name : option.get_snames()) described.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) described.names.push_back("--" + name);
  if (option.get_positional()) described.names = {option.get_name(true)};
  const bool is_flag = option.get_items_expected_max() == 0;
  if (!is_flag && !option.get_positional()) described.value = option.get_type_name();
  described.text = option.get_description();
  for (const CLI::Option* other : option.get_needs())
    described.text += " (needs " + other->get_name() + ")";
  for (const CLI::Option* other : option.get_excludes())
    described.text += " (not with " + other->get_name() + ")";
  described.group = heading;
  if (heading.empty() && option.get_group() != "Options") described.group = option.get_group();
  described.choices = hint_words(option, kChoices);
  described.endings = hint_words(option, kEndings);
  described.required = option.get_required();
  described.repeated = option.get_items_expected_max() > 1 &&
                       (option.get_positional() || option.get_allow_extra_args());
  return described;
}

// Adds the options of a command, or of a group of options, and its commands.
void describe(const CLI::App& app, const std::string& heading, Manual* manual) {
  for (const CLI::App* each : app.get_subcommands({})) {
    if (each->get_name().empty()) {
      const bool one = each->get_require_option_min() == 1;
      describe(*each, each->get_group() + (one ? " (exactly one is required)" : ""), manual);
      continue;
    }
    manual->commands.push_back(manual_of(*each));
    manual->commands.back().command = manual->command + " " + each->get_name();
  }
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    if (!heading.empty() && option == app.get_help_ptr())
      continue;  // CLI11 adds one to every group
    (option->get_positional() ? manual->operands : manual->options)
        .push_back(describe_option(*option, heading));
  }
}

}  // namespace

Manual manual_of(const CLI::App& program) {
  Manual manual = {program.get_name(), program.get_description(), {}, {}, program.get_footer(), {}};
  describe(program, "", &manual);
  return manual;
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
  if (!manual.commands.empty() && &command_of(manual, words) == &manual && !words.empty() &&
      words[0] == "help") {
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
  const auto check = [choices](const std::string& value) {
    if (std::ranges::find(choices, value) != choices.end()) return std::string();
    return "\"" + value + "\" is not one of " + CLI::detail::join(choices, ", ");
  };
  return suggests(option->check(check), choices);
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
  one_of(command->add_option_function<std::string>(
             "--layout",
             [layout](const std::string& name) {
               *layout = name == layout_name(Layout::kPlain) ? Layout::kPlain : Layout::kCompact;
             },
             "plain (default), or compact: less than half the bytes, traced almost as fast"),
         {layout_name(Layout::kPlain), layout_name(Layout::kCompact)})
      ->type_name("LAYOUT");
}

void add_layer(CLI::App* command, std::vector<std::string>* layers) {
  command
      ->add_option("--layer", *layers,
                   "Only the layers of this name or pattern (svdag info --layers lists them), "
                   "!PATTERN: all but these; may be repeated")
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

void add_vox_up(CLI::App* command, std::optional<int>* up) {
  one_of(
      command->add_option_function<std::string>(
          "--up", [up](const std::string& axis) { *up = axis[0] - 'x'; },
          "vox: the axis of the .svdag that points up, which is z in a .vox: x, y (default) or z"),
      {"x", "y", "z"})
      ->type_name("AXIS");
}

void add_examples(CLI::App* command, const std::vector<std::string>& lines,
                  const std::string& before) {
  std::string notes = before + (before.empty() ? "" : "\n\n");
  notes += lines.size() == 1 ? "Example:\n" : "Examples:\n";
  for (const std::string& line : lines) notes += "  " + line + "\n";
  command->footer(notes + "\n" + kExitCodes);
}

}  // namespace svdag
