// The program `svdag-import`, which `svdag import` starts.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "builder/commands/import/import_command.h"
#include "io/help/command_line.h"
#include "io/units.h"
#include "streaming/counts.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/program.h"
#include "streaming/process/terminate_handler.h"

namespace svdag {
namespace {

// --voxel-size: points state no units.
double size_of(const std::string& text) {
  if (text.find_first_not_of("0123456789.eE+-") != std::string::npos)
    fail_usage("--voxel-size: \"" + text + "\" is not a size like 0.5, in units of the points");
  return parse_voxel_size(text, 0);
}

// --layers.
LayerKind layers_of(const std::string& kind) {
  if (kind != "class" && kind != "file")
    fail_usage("--layers: unknown kind \"" + kind + "\": choose class or file");
  return kind == "file" ? LayerKind::kFile : LayerKind::kMaterial;
}

void set_up(CLI::App* app, ImportCommandConfig* config) {
  std::string formats;
  for (const std::string& name : import_formats()) formats += (formats.empty() ? "" : ", ") + name;
  ImportConfig* import = &config->import;
  takes_files(
      app->add_option("FILE", config->files, "A file of another program; points: or several"),
      {"*"})
      ->required();
  takes_files(app->add_option("-o,--output", import->output, "The .svdag to write"), {".svdag"})
      ->required()
      ->type_name("OUT");
  suggests(
      app->add_option("--format", config->format, formats + " (default: from the file content)"),
      import_formats())
      ->type_name("NAME");
  app->add_option_function<std::string>(
         "-r,--resolution",
         [import](const std::string& s) { import->levels = parse_resolution(s); },
         "vdb, npz, binvox, vox: voxels per axis of the grid (default: from the file, or the "
         "smallest that holds the voxels); points: of a grid that divides their box")
      ->type_name("N");
  app->add_option_function<std::string>(
         "-s,--voxel-size", [config](const std::string& s) { config->voxel_size = size_of(s); },
         "points: side of a voxel in their units; voxel planes at k times it")
      ->type_name("S");
  from_to(app->add_option("--min-points", import->min_points,
                          "points: a voxel needs at least this many (default: 1)"),
          1, 1000000000)
      ->type_name("N");
  suggests(app->add_option_function<std::string>(
               "--layers", [config](const std::string& kind) { config->layers = layers_of(kind); },
               "points: also keep the voxels of each class (las) or file, as layers"),
           {"class", "file"})
      ->type_name("KIND");
  app->add_option("--grid", config->grid, "vdb: the grid to read (default: the only one)")
      ->type_name("NAME");
  app->add_option_function<std::string>(
         "--iso", [config](const std::string& text) { config->iso = parse_iso(text); },
         "vdb: the values of a float grid that are set, for example --iso=-inf,0")
      ->type_name("LOW,HIGH");
  add_vox_up(app, &config->up);
  app->add_flag("--no-layers", config->no_layers,
                "npz, vox: no layers of their labels or palette numbers");
  app->add_flag("--no-colours", config->no_colours,
                "npz, vox, hashdag, points: no colours of voxels");
  app->add_flag("--sandbox", config->sandbox,
                "vdb: decode in a process that can only compute, for untrusted files");
  add_layout(app, &import->layout);
  add_memory_budget(app, &import->memory);
  from_to(app->add_option("-j,--threads", config->threads, "Threads (default: all processors)"), 1,
          kMaxThreads)
      ->type_name("N");
  takes_folder(
      app->add_option("--scratch", import->scratch,
                      "Folder for data that does not fit in memory (default: OUT.scratch)"))
      ->type_name("DIR");
  add_no_clobber(app, &config->no_clobber);
  app->add_flag("--json", config->json, "Print counts and content hash as JSON");
  app->add_flag("-q,--quiet", config->quiet, "Print errors only");
  add_examples(app,
               {"svdag import atrium64k.basic_dag.dag.bin -o atrium.svdag",
                "svdag import points.npz -o points.svdag -r 1K",
                "svdag import tile.las -o tile.svdag -s 0.05 --layers class",
                "svdag import levelset.vdb --iso=-inf,0 -o solid.svdag"},
               "See also: svdag help formats.");
}

int run_command(int argc, char** argv) {
  CLI::App app("Converts voxels of another program to a minimal .svdag.", "svdag import");
  app.set_version_flag("-V,--version", "svdag-import " SVDAG_VERSION, "Print the version and exit");
  ImportCommandConfig config;
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
