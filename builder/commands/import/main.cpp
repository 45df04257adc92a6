// The program `svdag-import`, which `svdag import` starts.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "builder/commands/import/import_command.h"
#include "io/help/command_line.h"
#include "io/units.h"
#include "streaming/counts.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/program.h"
#include "streaming/process/terminate_handler.h"

namespace svdag {
namespace {

void set_up(CLI::App* app, ImportCommandConfig* config) {
  std::string formats;
  for (const std::string& name : import_formats()) formats += (formats.empty() ? "" : ", ") + name;
  ImportConfig* import = &config->import;
  takes_files(app->add_option("FILE", config->file, "A file of another program"), {"*"})
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
         "vdb, npz, binvox, vox, ply: voxels per axis of the grid (default: from the file, or the "
         "smallest that holds the voxels)")
      ->type_name("N");
  app->add_option("--grid", config->grid, "vdb: the grid to read (default: the only one)")
      ->type_name("NAME");
  app->add_option_function<std::string>(
         "--iso", [config](const std::string& text) { config->iso = parse_iso(text); },
         "vdb: the values of a float grid that are set, for example --iso=-inf,0")
      ->type_name("LOW,HIGH");
  add_vox_up(app, &config->up);
  app->add_flag("--no-layers", config->no_layers,
                "npz, vox: no layers of their labels or palette numbers");
  app->add_flag("--no-colours", config->no_colours, "npz, vox, ply, hashdag: no colours of voxels");
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
