// The program `svdag`: the command line.
#include <CLI/CLI.hpp>

#include "builder/commands/options.h"
#include "builder/commands/sibling.h"
#include "io/suggest.h"
#include "streaming/interrupt.h"
#include "streaming/program.h"

namespace svdag {
namespace {

int run_command(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "export") become_sibling("svdag-export", argv);
  if (argc > 1 && std::string_view(argv[1]) == "import") become_sibling("svdag-import", argv);
  CLI::App app("Bakes triangle scenes as sparse voxel DAGs.", "svdag");
  app.set_version_flag("--version", "svdag " SVDAG_VERSION);
  app.require_subcommand(1);
  app.footer("svdag COMMAND --help explains a command.");
  BuildCommandConfig build;
  MergeCommandConfig merge;
  PlanCommandConfig plan;
  RunCommandConfig run;
  SubmitConfig submit;
  InfoConfig info;
  CLI::App* build_app = add_build(&app, &build);
  CLI::App* merge_app = add_merge(&app, &merge);
  CLI::App* plan_app = add_plan(&app, &plan);
  CLI::App* run_app = add_run(&app, &run);
  CLI::App* submit_app = add_submit(&app, &submit);
  add_info(&app, &info);
  app.add_subcommand("export", "Write the voxels of a .svdag in another format");
  app.add_subcommand("import", "Make a .svdag of the voxels of another program");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    fail_usage(explain(app, argc, argv, error));
  }
  return build_app->parsed()    ? run_build(build)
         : merge_app->parsed()  ? run_merge(merge)
         : plan_app->parsed()   ? run_plan(plan)
         : run_app->parsed()    ? run_run(run)
         : submit_app->parsed() ? run_submit(submit)
                                : run_info(info);
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  svdag::catch_interrupts();
  const svdag::ProgramWords words{.name = "svdag",
                                  .stopped = "stopped; nothing was saved to continue from",
                                  .resumable = "stopped; the same command with --resume continues"};
  return svdag::run_program(words, [&] { return svdag::run_command(argc, argv); });
}
