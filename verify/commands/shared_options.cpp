// Options of several commands.
#include <CLI/CLI.hpp>

#include "io/help/command_line.h"
#include "io/help/scene_options.h"
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
  add_scene_choice(command, scene);
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
