// Options shared by several commands.
#include <CLI/CLI.hpp>

#include "builder/commands/options.h"
#include "io/help/command_line.h"
#include "io/units.h"
#include "streaming/counts.h"
#include "streaming/error.h"

namespace svdag {
namespace {

Rule parse_rule(const std::string& name) {
  if (const auto rule = rule_named(name)) return *rule;
  fail_usage("--rule: unknown rule \"" + name + "\": choose conservative or thin");
}

double checked_voxel_size(double size) {
  if (size == 0) fail_usage("--voxel-size: 0 is not a size");
  return size;
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

void add_scene_options(CLI::App* app, NameFilter* names, bool* skip_invalid, bool* sandbox) {
  app->add_option("--include", names->include,
                  "Only parts whose name matches a pattern (*, ?, [..]); may be repeated")
      ->allow_extra_args(false)
      ->type_name("PATTERN");
  app->add_option("--exclude", names->exclude,
                  "Skip parts whose name matches a pattern; may be repeated")
      ->allow_extra_args(false)
      ->type_name("PATTERN");
  app->add_flag("--skip-invalid", *skip_invalid, "Drop triangles with NaN or infinite coordinates");
  app->add_flag("--sandbox", *sandbox,
                "Decode Draco and OpenMesh data in a limited process: for untrusted scenes");
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

CLI::Option_group* add_grid_options(CLI::App* app, BuildConfig* build) {
  CLI::Option_group* grid = app->add_option_group("Grid");
  grid->add_option_function<std::string>(
          "-r,--resolution",
          [build](const std::string& s) {
            build->levels = parse_resolution(s);
            build->voxel_size = 0;
          },
          "Voxels along the longest side: a power of two, 8 to 1M, for example 64K")
      ->type_name("N");
  grid->add_option_function<double>(
          "-s,--voxel-size",
          [build](double s) {
            build->voxel_size = checked_voxel_size(s);
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
         "--bounds", [build](const std::string& s) { build->bounds = parse_bounds(s); },
         "Bake only this box, in scene units")
      ->type_name("x0,y0,z0,x1,y1,z1");
  suggests(app->add_option_function<std::string>(
               "--rule", [build](const std::string& s) { build->descent.rule = parse_rule(s); },
               "conservative (default): every voxel that a triangle touches; thin: 6-separating, "
               "often 1.05 (walls) to 1.9 (curved surfaces) times fewer voxels"),
           {"conservative", "thin"})
      ->type_name("RULE");
  add_scene_options(app, &build->scene.names, &build->scene.skip_invalid, &build->scene.sandbox);
  return grid;
}

}  // namespace svdag
