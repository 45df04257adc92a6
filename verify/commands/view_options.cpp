// The command line of `svdag-verify view`.
#include <CLI/CLI.hpp>

#include "io/help/command_line.h"
#include "verify/commands/options.h"

namespace svdag {

void add_view(CLI::App* app, VerifyCommand* parsed) {
  auto config = std::make_shared<ViewConfig>();
  CLI::App* command = app->add_subcommand("view", "Fly through the voxels in the browser");
  add_file(command, &config->file);
  suggests(
      command->add_option("--up", config->up, "The axis that points up: x, y or z (default y)"),
      {"x", "y", "z"})
      ->type_name("AXIS");
  command
      ->add_option("--level", config->level,
                   "Show nothing finer than the cubes of level K, from 3 on (default: voxels)")
      ->type_name("K");
  CLI::Option* to =
      takes_folder(command->add_option("--to", config->to,
                                       "Write the page and its tiles to a folder, for any web "
                                       "server; a run that was stopped is continued"))
          ->type_name("FOLDER");
  CLI::Option* at =
      command
          ->add_option("--at", config->at,
                       "Serve at this port, or at the address that an earlier run has printed "
                       "(default: a free port, a random token)")
          ->type_name("PORT[/TOKEN]");
  CLI::Option* keep = command->add_flag(
      "--keep", config->keep, "Serve until Ctrl-C (default: until the page has been closed)");
  CLI::Option* quiet = command->add_flag_callback(
      "--no-open", [config] { config->open = false; }, "Print the address only");
  for (CLI::Option* const option : {at, keep, quiet}) option->excludes(to);
  add_threads(command, &config->common);
  add_common(command, &config->common, false);
  add_examples(command, {"svdag-verify view scene.svdag",
                         "svdag-verify view scene.svdag --to site --level 12"});
  command->callback([=] { *parsed = *config; });
}

}  // namespace svdag
