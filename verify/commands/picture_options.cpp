// The commands that show a file: render, report and view.
#include <CLI/CLI.hpp>

#include "io/help/command_line.h"
#include "io/units.h"
#include "verify/commands/options.h"

namespace svdag {

void add_render(CLI::App* app, VerifyCommand* parsed) {
  auto config = std::make_shared<RenderCommandConfig>();
  CLI::App* command =
      app->add_subcommand("render", "Make a picture by tracing rays through the DAG");
  add_file(command, &config->file);
  takes_files(command->add_option("-o,--output", config->output, "The PNG to write"), {".png"})
      ->required()
      ->type_name("X.png");
  suggests(command->add_option(
               "--mode", config->mode,
               "primary, shadow, soft, ao, normal, depth, level, steps or colour (default: colour, "
               "or primary where the file has none)"),
           {"primary", "shadow", "soft", "ao", "normal", "depth", "level", "steps", "colour"})
      ->type_name("MODE");
  add_selection(command, &config->selection, false);
  add_camera(command, &config->view);
  add_rays(command, &config->view,
           {"over the left shoulder", "soft 16, ao 64", "a twentieth of the scene's diagonal",
            "ao 9, soft 0, which is exact"});
  command
      ->add_option(
          "--level", config->level,
          "Trace the cubes of level K, from 1 on, instead of the voxels (svdag info --levels lists "
          "them)")
      ->type_name("K");
  command
      ->add_option_function<std::string>(
          "--clip",
          [config](const std::string& text) { config->clip = parse_bounds(text, "--clip"); },
          "Show only the voxels in this box; cut matter is red")
      ->type_name("x0,y0,z0,x1,y1,z1");
  command
      ->add_option("--slice", config->slice,
                   "Show only the voxels from this plane on, away from the camera, for example "
                   "z=1.5; cut matter is red")
      ->type_name("AXIS=V");
  command->add_flag("--grid-lines", config->grid_lines,
                    "Draw the edges of voxels that are several pixels large");
  CLI::Option* fly =
      command
          ->add_option("--fly", config->fly,
                       "Render N frames of a full turn, 1 to 9999, as X_0001.png, X_0002.png, ...")
          ->type_name("N");
  command
      ->add_flag("--frames", config->frames,
                 "Render each layer, in the order of svdag info --layers, as X_0001.png, ...")
      ->excludes(fly);
  command
      ->add_option("--supersample", config->supersample,
                   "N x N rays per pixel, N from 1 to 16 (default 2)")
      ->type_name("N");
  add_threads(command, &config->common);
  add_common(command, &config->common, false);
  add_examples(command, {"svdag-verify render scene.svdag -o scene.png",
                         "svdag-verify render scene.svdag -o ao.png --mode ao --preset inside",
                         "svdag-verify render scene.svdag -o in.png --camera=-9,2,0,8,3,0,65",
                         "svdag-verify render scene.svdag -o plan.png --preset top --slice y=1.5"});
  command->callback([=] { *parsed = *config; });
}

void add_report(CLI::App* app, VerifyCommand* parsed) {
  auto config = std::make_shared<ReportConfig>();
  CLI::App* command = app->add_subcommand(
      "report", "Make an HTML page about a .svdag: pictures, verdicts, levels, times");
  add_file(command, &config->file);
  takes_files(command->add_option("JSON", config->inputs,
                                  "The file of svdag build --report, and outputs of svdag-verify "
                                  "check, mesh, trace or vdb with --json"),
              {".json"});
  takes_files(command->add_option("-o,--output", config->output, "The page to write"), {".html"})
      ->required()
      ->type_name("R.html");
  add_up(command, &config->up);
  add_size(command, &config->size, "Pixels of a picture");
  add_threads(command, &config->common);
  add_common(command, &config->common, false);
  add_examples(command, {"svdag-verify report a.svdag a.json -o a.html",
                         "svdag-verify report a.svdag a.json mesh.json trace.json -o a.html"});
  command->callback([=] { *parsed = *config; });
}

void add_view(CLI::App* app, VerifyCommand* parsed) {
  auto config = std::make_shared<ViewConfig>();
  CLI::App* command = app->add_subcommand("view", "Fly through the voxels in the browser");
  add_file(command, &config->file);
  add_up(command, &config->up);
  command
      ->add_option("--level", config->level,
                   "Show nothing finer than the cubes of level K, from 3 on (default: voxels)")
      ->type_name("K");
  add_selection(command, &config->selection, false);
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
