// Options shared by several commands.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "builder/commands/options.h"
#include "io/dag/grid_fields.h"
#include "io/help/command_line.h"
#include "io/help/scene_options.h"
#include "io/units.h"
#include "streaming/counts.h"
#include "streaming/error.h"

namespace svdag {
namespace {

Rule parse_rule(const std::string& name) {
  const auto rule = rule_named(name);
  if (rule == Rule::kPoints)
    fail_usage("--rule points: only for files of points: use svdag import");
  if (rule) return *rule;
  fail_usage("--rule: unknown rule \"" + name + "\": choose conservative, thin or solid");
}

// Which winding numbers a solid rule counts as inside.
Rule parse_inside(const std::string& name, Rule rule) {
  if (name != "nonzero" && name != "odd")
    fail_usage("--inside: unknown kind \"" + name + "\": choose nonzero or odd");
  if (!is_solid(rule)) fail_usage("--inside needs --rule solid");
  return name == "odd" ? Rule::kSolidOdd : Rule::kSolid;
}

// Whether open parts are baked as surfaces.
bool parse_open(const std::string& name, Rule rule) {
  if (name != "error" && name != "surface")
    fail_usage("--open: unknown kind \"" + name + "\": choose error or surface");
  if (!is_solid(rule)) fail_usage("--open needs --rule solid");
  return name == "surface";
}

double checked_scale(double scale) {
  if (!std::isnormal(scale)) fail_usage("--scale: give a factor other than 0");
  return scale;
}

}  // namespace

void add_quiet(CLI::App* app, OutputConfig* output) {
  app->add_flag("-q,--quiet", output->quiet, "Print errors only");
}

void add_verbose(CLI::App* app, OutputConfig* output, const std::string& text) {
  app->add_flag("-v,--verbose", output->verbose, text);
}

void add_progress(CLI::App* app, OutputConfig* output) {
  app->add_flag_callback(
      "--progress", [output] { output->progress = Progress::Mode::kOn; },
      "Show progress even if stderr is not a terminal");
  app->add_flag_callback(
      "--no-progress", [output] { output->progress = Progress::Mode::kOff; },
      "Never show progress");
}

void add_scene_options(CLI::App* app, SceneConfig* scene) {
  add_scene_choice(app, scene);
  app->add_flag(
      "--sandbox", scene->sandbox,
      "Run Assimp, ufbx, Draco, meshoptimizer, OpenMesh and stb_image in a process that can only "
      "compute: for untrusted scenes");
  app->add_option_function<std::string>(
         "--transform", [scene](const std::string& s) { scene->transform = parse_transform(s); },
         "Transform the scene by a 4x4 matrix, row by row; bounds and sizes are those after it")
      ->type_name("m00,m01,...,m33");
  suggests(
      app->add_option_function<std::string>(
          "--up", [scene](const std::string& s) { scene->up = parse_up(s); },
          "The axis that points up in the scene: x, y or z (or --up=-z); it is rotated to y, after "
          "--transform"),
      {"x", "y", "z"})
      ->type_name("AXIS");
  app->add_option_function<double>(
         "--scale", [scene](double s) { scene->scale = checked_scale(s); },
         "Multiply coordinates by a factor, after --transform and --up")
      ->type_name("FACTOR");
}

void add_resource_options(CLI::App* app, uint64_t* memory, size_t* threads, std::string* scratch,
                          const char* own_scratch, const char* threads_text) {
  add_memory_budget(app, memory);
  from_to(app->add_option("-j,--threads", *threads, threads_text), 1, kMaxThreads)->type_name("N");
  takes_folder(app->add_option("--scratch", *scratch,
                               "Folder for data that does not fit in memory (default: " +
                                   std::string(own_scratch) + ")"))
      ->type_name("DIR");
}

CLI::Option* add_checkpoint(CLI::App* app, double* seconds) {
  const auto read = [=](double given) {
    if (!(given > 0)) fail_usage("--checkpoint: must be more than 0 seconds");
    *seconds = given;
  };
  return app
      ->add_option_function<double>("--checkpoint", read,
                                    "Save work every SECONDS seconds (default: 30)")
      ->type_name("SECONDS");
}

void add_resume_options(CLI::App* app, Unfinished* unfinished, double* checkpoint) {
  CLI::Option* resume = app->add_flag_callback(
      "--resume", [=] { *unfinished = Unfinished::kResume; },
      "Continue unfinished work on this output, if there is any (with the same --scratch)");
  app->add_flag_callback(
         "--restart", [=] { *unfinished = Unfinished::kRestart; },
         "Discard unfinished work on this output")
      ->excludes(resume);
  add_checkpoint(app, checkpoint);
}

std::array<CLI::Option*, 2> add_colour_options(CLI::App* app,
                                               const std::function<ColourPassConfig&()>& pass) {
  CLI::Option* const level =
      from_to(app->add_option_function<int>(
                  "--colour-level", [pass](int k) { pass().level = k; },
                  "The finest cubes with a colour: 2^K along an edge of the grid (default: the "
                  "level at which a cube spans one to two texels)"),
              kMinColourLevel, 20)
          ->type_name("K");
  CLI::Option* const error =
      app->add_option_function<double>(
             "--colour-error",
             [pass](double steps) {
               if (!(steps >= 0 && steps <= 255))
                 fail_usage("--colour-error: choose 0 to 255 steps");
               pass().error = uint32_t(steps * kColourErrorUnit);
             },
             "Largest error of a colour, of 255 steps; 0 is lossless (default: 9)")
          ->type_name("STEPS");
  return {level, error};
}

void add_colours(CLI::App* app, std::optional<ColourPassConfig>* colours) {
  const auto pass = [colours]() -> ColourPassConfig& {
    if (!*colours) colours->emplace();
    return **colours;
  };
  const bool is_default = colours->has_value();  // of the batch
  CLI::Option* const flag = app->add_flag_callback(
      "--colours", [pass] { pass(); }, "Also add the colours of the scene, as svdag colour does");
  for (CLI::Option* option : add_colour_options(app, pass)) {
    if (!is_default) option->needs(flag);
  }
}

void add_frames(CLI::App* app, BuildConfig* build) {
  add_frames(app, &build->scene, [build] {
    build->layers = LayerKind::kFrame;
    build->with_union = build->scene.colours = false;
    build->scene.time.reset();
  });
}

void add_layer_options(CLI::App* app, BuildConfig* build) {
  const auto read = [build](const std::string& name) {
    const auto known = std::ranges::find(kLayerKindNames, name);
    if (known == std::end(kLayerKindNames) || name == layer_kind_name(LayerKind::kNone) ||
        name == layer_kind_name(LayerKind::kFrame))
      fail_usage("--layers: unknown kind \"" + name + "\": choose material, object or file");
    if (!build->scene.frames.empty()) fail_usage("--layers: the layers of --frames are its times");
    build->layers = LayerKind(known - kLayerKindNames);
    build->scene.colours = build->layers == LayerKind::kMaterial;
  };
  CLI::Option* layers =
      suggests(
          app->add_option_function<std::string>(
              "--layers", read, "Also keep the voxels of each material, object or file, as layers"),
          {"material", "object", "file"})
          ->type_name("KIND");
  CLI::Option* no_union = app->add_flag_callback(
      "--no-union", [build] { build->with_union = false; }, "Keep only the layers");
  if (build->layers == LayerKind::kNone) no_union->needs(layers);
}

void add_palette(CLI::App* app, LayerPalette* palette) {
  takes_files(
      app->add_option_function<std::string>(
          "--palette", [palette](const std::string& path) { *palette = read_palette(path); },
          "Colours of layers: a name or pattern and #rrggbb a line; the last that matches"),
      {".txt"})
      ->type_name("FILE");
}

CLI::Option_group* add_grid_options(CLI::App* app, BuildConfig* build) {
  // Before -s: callbacks run in the order of definition.
  const auto unit = std::make_shared<double>(0);  // in metres
  suggests(app->add_option_function<std::string>(
               "--units", [unit](const std::string& s) { *unit = parse_unit(s); },
               "What one unit of the scene is (mm, cm, m, km, in or ft), so that -s may be given "
               "as 5cm"),
           {"mm", "cm", "m", "km", "in", "ft"})
      ->type_name("UNIT");
  CLI::Option_group* grid = app->add_option_group("Grid");
  grid->add_option_function<std::string>(
          "-r,--resolution",
          [build](const std::string& s) {
            build->levels = parse_resolution(s);
            build->voxel_size = 0;
          },
          "Voxels along the longest side: a power of two, 8 to 1M, for example 64K")
      ->type_name("N");
  grid->add_option_function<std::string>(
          "-s,--voxel-size",
          [build, unit](const std::string& s) {
            build->voxel_size = parse_voxel_size(s, *unit);
            build->levels = 0;
          },
          "Side of a voxel in scene units; voxel planes at (k + 1/2) times it")
      ->type_name("S");
  grid->require_option(1);
  app->add_option_function<std::string>(
         "--cube", [build](const std::string& s) { build->cube = parse_cube(s); },
         "Divide exactly this cube into the voxels of -r, so that resolutions line up")
      ->type_name("x,y,z,side");
  app->add_option_function<std::string>(
         "--origin", [build](const std::string& s) { build->origin = parse_origin(s); },
         "Put a corner of voxels here: planes are whole steps of -s from it")
      ->type_name("x,y,z");
  app->add_option_function<std::string>(
         "--bounds", [build](const std::string& s) { build->bounds = parse_bounds(s); },
         "Bake only this box, in scene units")
      ->type_name("x0,y0,z0,x1,y1,z1");
  suggests(app->add_option_function<std::string>(
               "--rule", [build](const std::string& s) { build->rule = parse_rule(s); },
               "conservative (default): every voxel that a triangle touches; thin: 6-separating, "
               "often 1.05 (walls) to 1.9 (curved surfaces) times fewer voxels; solid: "
               "conservative, and the inside of closed surfaces"),
           {"conservative", "thin", "solid"})
      ->type_name("RULE");
  // After --rule, since options are applied in the order of their definition.
  suggests(
      app->add_option_function<std::string>(
          "--inside", [build](const std::string& s) { build->rule = parse_inside(s, build->rule); },
          "With --rule solid, inside is where the surface winds around: nonzero (default), or "
          "odd, for surfaces without consistent orientation"),
      {"nonzero", "odd"})
      ->type_name("KIND");
  suggests(
      app->add_option_function<std::string>(
          "--open",
          [build](const std::string& s) { build->open_as_sheets = parse_open(s, build->rule); },
          "With --rule solid, what to do with a scene that is not closed: error (default), or "
          "bake its open objects as surfaces"),
      {"error", "surface"})
      ->type_name("KIND");
  add_scene_options(app, &build->scene);
  return grid;
}

}  // namespace svdag
