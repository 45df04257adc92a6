// svdag-verify: the independent judge of what `svdag build` wrote.
#include <CLI/CLI.hpp>

#include "io/help/command_line.h"
#include "streaming/process/program.h"
#include "streaming/process/terminate_handler.h"
#include "verify/commands/options.h"

namespace svdag {
namespace {

int run_judge(int argc, char** argv) {
  CLI::App app("Judges .svdag files independently of the builder.", "svdag-verify");
  app.set_version_flag("-V,--version", "svdag-verify " SVDAG_VERSION, "Print the version and exit");
  app.require_subcommand(1);
  add_examples(&app, {"svdag-verify check scene.svdag", "svdag-verify mesh scene.svdag scene.ply"});
  VerifyCommand command;
  add_check(&app, &command);
  add_mesh(&app, &command);
  add_colours(&app, &command);
  add_diff(&app, &command);
  add_vdb(&app, &command);
  add_trace(&app, &command);
  add_render(&app, &command);
  add_report(&app, &command);
  add_view(&app, &command);
  if (const auto done = read_command_line(&app, argc, argv)) return *done;
  return std::visit([](const auto& parsed) { return run(parsed); }, command);
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  return svdag::run_program({"svdag-verify", "not enough memory on this machine"},
                            [&] { return svdag::run_judge(argc, argv); });
}
