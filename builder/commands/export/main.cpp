// The program `svdag-export`, which `svdag export` starts.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "builder/commands/export/export.h"
#include "io/formats/voxels/distances.h"
#include "io/help/command_line.h"
#include "io/units.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/program.h"
#include "streaming/process/terminate_handler.h"

namespace svdag {
namespace {

void set_up(CLI::App* app, ExportConfig* config) {
  std::string formats;
  std::vector<std::string> names;
  for (const ExportFormat& format : export_formats()) {
    names.push_back(format.name);
    formats += std::string(formats.empty() ? "" : "; ") + format.name + ": " + format.description;
  }
  takes_files(app->add_option("FILE", config->file, "The .svdag file"), {".svdag"})->required();
  takes_files(app->add_option("-o,--output", config->output, "The file to write"), {"*"})
      ->required()
      ->type_name("OUT");
  suggests(app->add_option("--format", config->format,
                           formats + " (default: by the output's extension)"),
           names)
      ->type_name("NAME");
  add_selection(app, &config->selection);
  app->add_option_function<std::string>(
         "--max-voxels",
         [config](const std::string& s) { config->max_voxels = parse_count(s, "--max-voxels"); },
         "npz, binvox, vox, ply: reject more voxels (or distances) than this (default: 10^9)")
      ->type_name("N");
  app->add_option_function<std::string>(
         "--max-quads",
         [config](const std::string& s) { config->max_quads = parse_count(s, "--max-quads"); },
         "glb, obj, stl, ply-surface: reject more quads than this (default: 10^9)")
      ->type_name("N");
  from_to(app->add_option("--distance", config->distance,
                          "npz: of each voxel of the part the distance to the nearest set one, in "
                          "voxels and at most N; negative in solids"),
          1, kMaxDistance)
      ->type_name("N");
  app->add_flag("--no-merge", config->no_merge,
                "glb, obj, stl, ply-surface: a quad for each face of a voxel, edge to edge");
  one_of(app->add_option_function<std::string>(
             "--vdb-type",
             [config](const std::string& name) {
               config->vdb_type = name == "mask"    ? VdbFormat::kMask
                                  : name == "float" ? VdbFormat::kFloat
                                                    : VdbFormat::kBool;
             },
             "vdb: bool (default), which every reader has; mask, the smallest in memory; float, "
             "a fog volume of 1 in 0"),
         {"bool", "mask", "float"})
      ->type_name("TYPE");
  add_vox_up(app, &config->up);
  app->add_flag("--colours", config->colours,
                "hashdag: write its colours beside it, or those of layers, 4 bytes a voxel");
  add_memory_budget(app, &config->memory);
  add_no_clobber(app, &config->no_clobber);
  app->add_flag("--json", config->json, "Print what was written as JSON");
  app->add_flag("-q,--quiet", config->quiet, "Print errors only");
  add_examples(app,
               {"svdag export city.svdag -o city.vdb --level 10",
                "svdag export city.svdag -o corner.nvdb --bounds=0,0,0,5,5,5",
                "svdag export city.svdag -o city.glb --level 9",
                "svdag export city.svdag --format hashdag -o city"},
               "See also: svdag help formats.");
}

int run_command(int argc, char** argv) {
  CLI::App app("Writes the voxels of a .svdag in another format.", "svdag export");
  app.set_version_flag("-V,--version", "svdag-export " SVDAG_VERSION, "Print the version and exit");
  ExportConfig config;
  set_up(&app, &config);
  if (const auto done = read_command_line(&app, argc, argv)) return *done;
  return run(config);
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  svdag::catch_interrupts();
  return svdag::run_program({"svdag"}, [&] { return svdag::run_command(argc, argv); });
}
