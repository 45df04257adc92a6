// The commands that make pictures: render and report.
#include <CLI/CLI.hpp>

#include "io/help/command_line.h"
#include "io/units.h"
#include "verify/commands/options.h"

namespace svdag {
namespace {

void add_light(CLI::App* command, RenderCommandConfig* config) {
  command
      ->add_option(
          "--light", config->light,
          "Position and radius of the light in scene units (default: over the left shoulder)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("x,y,z[,radius]");
  command
      ->add_option("--samples", config->samples,
                   "soft, ao: rays to the light or sky for each camera ray, 1 to 4096 (default 16)")
      ->type_name("N");
  command
      ->add_option("--reach", config->reach,
                   "ao: length of the rays in scene units (default: a twentieth of the scene's "
                   "diagonal)")
      ->type_name("LENGTH");
  command
      ->add_option("--cone", config->cone,
                   "soft, ao: half the angle, from 0 and below 45, of the cone in which rays end "
                   "early (default: ao 9, "
                   "soft 0, which is exact)")
      ->type_name("DEGREES");
}

}  // namespace

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
               "or primary without layers)"),
           {"primary", "shadow", "soft", "ao", "normal", "depth", "level", "steps", "colour"})
      ->type_name("MODE");
  add_layer(command, &config->layers);
  command->add_option("--size", config->size, "Pixels, 1 to 16384 each way (default 1280x720)")
      ->type_name("WxH");
  command
      ->add_option("--camera", config->camera,
                   "Position and target in scene units, angle of view in degrees, 0.1 to 179 "
                   "(default: frames all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("px,py,pz,tx,ty,tz[,fov]");
  suggests(command->add_option("--preset", config->preset,
                               "iso, front, back, left, right, top or inside, without --camera "
                               "(default iso)"),
           {"iso", "front", "back", "left", "right", "top", "inside"})
      ->type_name("NAME");
  add_light(command, config.get());
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
  suggests(
      command->add_option("--up", config->up, "The axis that points up: x, y or z (default y)"),
      {"x", "y", "z"})
      ->type_name("AXIS");
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
  suggests(
      command->add_option("--up", config->up, "The axis that points up: x, y or z (default y)"),
      {"x", "y", "z"})
      ->type_name("AXIS");
  command
      ->add_option("--size", config->size,
                   "Pixels of a picture, 1 to 16384 each way (default 960x540)")
      ->type_name("WxH");
  add_threads(command, &config->common);
  add_common(command, &config->common, false);
  add_examples(command, {"svdag-verify report a.svdag a.json -o a.html",
                         "svdag-verify report a.svdag a.json mesh.json trace.json -o a.html"});
  command->callback([=] { *parsed = *config; });
}

}  // namespace svdag
