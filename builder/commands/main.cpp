// The program `svdag`: the command line.
#include <CLI/CLI.hpp>

#include "builder/commands/help.h"
#include "builder/commands/options.h"
#include "builder/commands/sibling.h"
#include "io/help/command_line.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/program.h"

namespace svdag {
namespace {

// Its choices are known when all other commands are there.
CLI::App* add_help(CLI::App* program, std::string* subject) {
  CLI::App* app = program->add_subcommand("help", "Explain a command or a topic");
  suggests(app->add_option("SUBJECT", *subject, "A command, or one of the topics below"),
           help_subjects(manual_of(*program)));
  app->footer(list_of_topics());
  return app;
}

int run_command(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "export") become_sibling("svdag-export", argv);
  if (argc > 1 && std::string_view(argv[1]) == "import") become_sibling("svdag-import", argv);
  CLI::App app("Bakes triangle scenes as sparse voxel DAGs.", "svdag");
  app.set_version_flag("-V,--version", "svdag " SVDAG_VERSION, "Print the version and exit");
  app.require_subcommand(1);
  BuildCommandConfig build;
  MergeCommandConfig merge;
  PlanCommandConfig plan;
  RunCommandConfig run;
  SubmitCommandConfig submit;
  InfoCommandConfig info;
  std::string subject;
  CLI::App* build_app = add_build(&app, &build);
  CLI::App* merge_app = add_merge(&app, &merge);
  CLI::App* plan_app = add_plan(&app, &plan);
  CLI::App* run_app = add_run(&app, &run);
  CLI::App* submit_app = add_submit(&app, &submit);
  CLI::App* info_app = add_info(&app, &info);
  app.add_subcommand("export", "Write the voxels of a .svdag in another format");
  app.add_subcommand("import", "Make a .svdag of the voxels of another program");
  add_help(&app, &subject);
  add_examples(&app,
               {"svdag build city.glb -o city.svdag -r 64K", "svdag help build", "svdag help grid"},
               list_of_topics() +
                   "\n\nsvdag-verify proves what was baked, and makes pictures of it; "
                   "svdag-trace traces rays through it.");
  if (const auto done = read_command_line(&app, argc, argv)) return *done;
  return build_app->parsed()    ? run_build(build)
         : merge_app->parsed()  ? run_merge(merge)
         : plan_app->parsed()   ? run_plan(plan)
         : run_app->parsed()    ? run_run(run)
         : submit_app->parsed() ? run_submit(submit)
         : info_app->parsed()   ? run_info(info)
                                : run_help(manual_of(app), subject);
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  svdag::catch_interrupts();
  // Two words to hold: more would take memory, before anybody could say that there is none.
  return svdag::run_program({.name = "svdag",
                             .stopped = "stopped; nothing was saved to continue from",
                             .resumable = "stopped; the same command with --resume continues"},
                            [argc, argv] { return svdag::run_command(argc, argv); });
}
