// svdag info.
#include <CLI/CLI.hpp>

#include "builder/commands/options.h"
#include "io/units.h"

namespace svdag {

CLI::App* add_info(CLI::App* program, InfoConfig* config) {
  CLI::App* app = program->add_subcommand("info", "Tell what a .svdag, a run or a scene contains");
  app->add_option("FILE", config->paths, "A .svdag or .run file, or the files of a scene")
      ->required();
  app->add_flag("--json", config->json, "Print JSON");
  app->add_flag("--levels", config->levels, "Print a table of the levels of a .svdag");
  add_scene_options(app, &config->names, &config->skip_invalid, &config->sandbox);
  app->add_option_function<std::string>(
         "-m,--memory",
         [config](const std::string& s) { config->memory = parse_count(s, "--memory"); },
         "Memory budget (default: half of the machine)")
      ->type_name("SIZE");
  app->footer("Examples:\n  svdag info city.svdag --levels\n  svdag info city.glb");
  return app;
}

}  // namespace svdag
