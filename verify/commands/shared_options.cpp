// Options of several commands.
#include <CLI/CLI.hpp>

#include "io/help/command_line.h"
#include "io/scene/scene_formats.h"
#include "io/units.h"
#include "streaming/counts.h"
#include "verify/commands/options.h"

namespace svdag {
namespace {

template <class Count>
void add_count_to(CLI::App* command, const std::string& option, Count* count, const char* text,
                  const char* type) {
  const std::string name = option.substr(option.find("--"));
  command
      ->add_option_function<std::string>(
          option,
          [name, count](const std::string& value) { *count = parse_count(value, name.c_str()); },
          text)
      ->type_name(type);
}

}  // namespace

void add_common(CLI::App* command, CommonConfig* config, bool with_json) {
  command->add_flag("-q,--quiet", config->quiet, "Print errors only");
  command->add_flag("-v,--verbose", config->verbose, "Also print seconds and memory");
  if (with_json) command->add_flag("--json", config->json, "Print the result as one JSON object");
  command->add_flag_callback(
      "--progress", [config] { config->progress = Progress::Mode::kOn; },
      "Show progress even if stderr is not a terminal");
  command->add_flag_callback(
      "--no-progress", [config] { config->progress = Progress::Mode::kOff; },
      "Never show progress");
}

void add_threads(CLI::App* command, CommonConfig* config) {
  from_to(command->add_option("-j,--threads", config->threads, "Threads (default: all processors)"),
          1, kMaxThreads)
      ->type_name("N");
}

void add_scene(CLI::App* command, SceneConfig* scene) {
  takes_files(command->add_option("SCENE", scene->paths, "The scene files it was baked from"),
              scene_endings())
      ->required();
  command
      ->add_option("--include", scene->names.include,
                   "Only parts whose object, material or file name matches a pattern (*, ?, "
                   "[..]; material:PATTERN for one kind); may be repeated")
      ->allow_extra_args(false)
      ->type_name("PATTERN");
  command
      ->add_option("--exclude", scene->names.exclude,
                   "Skip parts whose name matches a pattern; may be repeated")
      ->allow_extra_args(false)
      ->type_name("PATTERN");
  command->add_flag("--allow-empty", scene->allow_unmatched,
                    "Accept a pattern that matches no name");
  command
      ->add_option_function<double>(
          "--time", [scene](double s) { pose_time(scene)->seconds = s; },
          "The time of animations that the bake was posed at")
      ->type_name("SECONDS");
  command
      ->add_option_function<std::string>(
          "--animation", [scene](const std::string& name) { pose_time(scene)->animation = name; },
          "The animation of that time: its name, #NUMBER from 0, or all")
      ->needs("--time")
      ->type_name("NAME");
  command->add_flag("--hidden", scene->hidden, "The bake has nodes that the file hides, too");
  command->add_flag("--skip-invalid", scene->skip_invalid,
                    "Drop triangles with NaN or infinity, as in the bake");
}

void add_count(CLI::App* command, const std::string& option, uint64_t* count, const char* text,
               const char* type) {
  add_count_to(command, option, count, text, type);
}

void add_count(CLI::App* command, const std::string& option, std::optional<uint64_t>* count,
               const char* text, const char* type) {
  add_count_to(command, option, count, text, type);
}

void add_memory(CLI::App* command, uint64_t* memory) {
  add_memory_budget(command, memory, "Memory budget of the readers and the triangles held");
}

void add_file(CLI::App* command, std::string* file) {
  takes_files(command->add_option("FILE", *file, "The .svdag file"), {".svdag"})->required();
}

}  // namespace svdag
