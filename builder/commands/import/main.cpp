// The program `svdag-import`, which `svdag import` starts.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "builder/commands/import/import_command.h"
#include "io/suggest.h"
#include "io/units.h"
#include "streaming/interrupt.h"
#include "streaming/program.h"

namespace svdag {
namespace {

void set_up(CLI::App* app, ImportCommandConfig* config) {
  std::string formats;
  for (const std::string& name : import_formats()) formats += (formats.empty() ? "" : ", ") + name;
  ImportConfig* import = &config->import;
  app->add_option("FILE", config->file, "A file of another program")->required();
  app->add_option("-o,--output", import->output, "The .svdag to write")->required();
  app->add_option("--format", config->format, formats + " (default: by what is in the file)")
      ->type_name("NAME");
  app->add_option_function<std::string>(
         "-r,--resolution",
         [import](const std::string& s) { import->levels = parse_resolution(s); },
         "Voxels per axis of the grid, where the file leaves it open (default: as few as its "
         "voxels "
         "need)")
      ->type_name("N");
  app->add_option("--grid", config->grid, "vdb: the grid to read (default: the only one)")
      ->type_name("NAME");
  app->add_option_function<std::string>(
         "-m,--memory",
         [import](const std::string& s) { import->memory = parse_count(s, "--memory"); },
         "Memory budget (default: half of the machine)")
      ->type_name("SIZE");
  app->add_option("-j,--threads", config->threads, "Threads (default: all processors)")
      ->check(CLI::Range(size_t(1), size_t(1024)));
  app->add_option("--scratch", import->scratch,
                  "Folder for what does not fit in memory (default: OUT.svdag.scratch)")
      ->type_name("DIR");
  app->add_flag("-q,--quiet", config->quiet, "Print errors only");
  app->footer(
      "Examples:\n"
      "  svdag import atrium64k.basic_dag.dag.bin -o atrium.svdag\n"
      "  svdag import points.npz -o points.svdag -r 1K");
}

int run_command(int argc, char** argv) {
  CLI::App app("Makes a minimal .svdag of the voxels of another program.", "svdag import");
  app.set_version_flag("--version", "svdag-import " SVDAG_VERSION);
  ImportCommandConfig config;
  set_up(&app, &config);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    fail_usage(explain(app, argc, argv, error));
  }
  return run(config);
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  svdag::catch_interrupts();
  return svdag::run_program({"svdag"}, [&] { return svdag::run_command(argc, argv); });
}
