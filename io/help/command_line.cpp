#include "io/help/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>

#include "io/help/help_text.h"
#include "io/help/lost_value.h"
#include "io/suggest.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/process/terminal.h"

namespace svdag {
namespace {

// A hint is stored in CLI11 as the name of a validator: one of these prefixes, and words.
constexpr const char* kChoices = "choices ";
constexpr const char* kEndings = "endings ";

constexpr uint64_t kMinMemory = 1 << 20;  // less does not suffice to read even small scenes

CLI::Option* hint(CLI::Option* option, const char* kind, const std::vector<std::string>& words,
                  CLI::Validator validator = CLI::Validator("")) {
  std::string name = kind;
  for (const std::string& word : words) name += word + " ";
  return option->check(validator.name(name));
}

// Returns the error. CLI11 itself would read -1, and numbers that are too large, as 2^64 - 1.
std::string check_whole_number(const std::string& text) {
  uint64_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = read.ec == std::errc() && read.ptr == text.data() + text.size();
  return whole ? "" : "\"" + text + "\" is not a whole number from 0 to 2^64 - 1";
}

// Returns the error. An empty name is a mistake, such as an unset variable in a script.
std::string check_not_empty(const std::string& name) {
  return name.empty() ? "the name is empty" : "";
}

// The words of a hint.
std::vector<std::string> hint_words(const CLI::Option& option, const std::string& kind) {
  std::vector<std::string> words;
  auto& validators = const_cast<CLI::Option&>(option);  // CLI11 has no const accessor
  for (int i = 0;; ++i) {
    const CLI::Validator* validator = nullptr;
    try {
      validator = validators.get_validator(i);
    } catch (const CLI::OptionNotFound&) {  // the only sign of the end of the list
      return words;
    }
    const std::string& name = validator->get_name();
    if (name.compare(0, kind.size(), kind) != 0) continue;
    for (size_t at = kind.size(); at < name.size(); at = name.find(' ', at) + 1)
      words.push_back(name.substr(at, name.find(' ', at) - at));
  }
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

// The manual of the command whose --help is requested.
Manual requested_manual(const CLI::App& program) {
  const std::vector<const CLI::App*> parsed = program.get_subcommands(
      [](const CLI::App* each) { return each->parsed() && !each->get_name().empty(); });
  return parsed.empty()
             ? manual_of(program)
             : describe(*parsed.front(), program.get_name() + " " + parsed.front()->get_name());
}

// Turns "help mesh" into "mesh --help", for a program without a command "help".
std::vector<char*> help_command_to_option(const Manual& program, int argc, char** argv) {
  static char option[] = "--help";
  std::vector<char*> words(argv, argv + argc);
  const auto is_help = [&](const Manual& each) {
    return each.command == program.command + " help";
  };
  if (argc < 2 || std::string_view(argv[1]) != "help" || program.commands.empty() ||
      std::any_of(program.commands.begin(), program.commands.end(), is_help))
    return words;
  words.erase(words.begin() + 1);
  words.resize(std::min<size_t>(words.size(), 2));
  words.push_back(option);
  return words;
}

// Turns "--help build" into "build --help", and ignores what follows --version.
std::vector<char*> help_or_version_first(const CLI::App& program, std::vector<char*> words) {
  if (words.size() < 3) return words;
  const std::string_view first = words[1];
  const bool help = program.get_help_ptr()->check_name(std::string(first));
  const CLI::Option* version_option = program.get_version_ptr();
  const bool version = version_option != nullptr && version_option->check_name(std::string(first));
  if (!help && !version) return words;
  const bool command = help && words[2][0] != '-';
  if (command) std::swap(words[1], words[2]);
  words.resize(command ? 3 : 2);
  return words;
}

// Whether the first word is an unknown command, as in "biuld --help", for which CLI11 would print
// the help of the program.
bool is_unknown_command(const CLI::App& program, int argc, char** argv) {
  return argc > 1 && argv[1][0] != '-' && !manual_of(program).commands.empty() &&
         requested_manual(program).command == program.get_name();
}

}  // namespace

Manual manual_of(const CLI::App& program) {
  return describe(program, program.get_name());
}

std::optional<int> read_command_line(CLI::App* program, int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == kManualTable) {
    std::fputs(to_table(manual_of(*program)).c_str(), stdout);
    return 0;
  }
  std::vector<char*> words = help_command_to_option(manual_of(*program), argc, argv);
  words = help_or_version_first(*program, std::move(words));
  argc = int(words.size());
  argv = words.data();
  const std::vector<std::string> given(argv + std::min(argc, 1), argv + argc);
  const std::string missing = explain_missing_value(*program, given);
  if (!missing.empty()) fail_usage(missing);
  try {
    program->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::CallForHelp& call) {
    if (is_unknown_command(*program, argc, argv)) fail_usage(explain(*program, given, call));
    std::fputs(help_text(requested_manual(*program), text_width(stdout)).c_str(), stdout);
    return 0;
  } catch (const CLI::Success& success) {  // --version
    return program->exit(success);
  } catch (const CLI::ParseError& error) {
    fail_usage(explain(*program, given, error));
  }
}

CLI::Option* suggests(CLI::Option* option, const std::vector<std::string>& choices) {
  return hint(option, kChoices, choices);
}

CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& choices) {
  const auto check = [choices](const std::string& value) {
    if (std::find(choices.begin(), choices.end(), value) != choices.end()) return std::string();
    std::string list;
    for (const std::string& choice : choices) list += (list.empty() ? "" : ", ") + choice;
    return "\"" + value + "\" is not one of " + list;
  };
  return suggests(option->check(CLI::Validator(check, "")), choices);
}

CLI::Option* takes_files(CLI::Option* option, const std::vector<std::string>& endings) {
  return hint(option, kEndings, endings, CLI::Validator(check_not_empty, ""));
}

CLI::Option* takes_whole_number(CLI::Option* option) {
  return option->check(CLI::Validator(check_whole_number, ""));
}

CLI::Option* takes_folder(CLI::Option* option) {
  return takes_files(option, {"/"});
}

CLI::Option* from_to(CLI::Option* option, size_t min, size_t max) {
  const std::string range = std::to_string(min) + " to " + std::to_string(max);
  std::string text = option->get_description();
  const size_t end = std::min(text.find(" (default"), text.size());
  text.insert(end, ", " + range);
  option->description(text);
  const auto check = [=](const std::string& value) {
    uint64_t number = 0;
    const auto read = std::from_chars(value.data(), value.data() + value.size(), number);
    const bool inside = read.ec == std::errc() && read.ptr == value.data() + value.size() &&
                        number >= min && number <= max;
    return inside ? std::string() : "\"" + value + "\" is not a number from " + range;
  };
  return option->check(CLI::Validator(check, ""));
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
