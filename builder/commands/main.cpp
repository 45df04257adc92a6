// The program `svdag`: the command line.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "builder/commands/help.h"
#include "builder/commands/options.h"
#include "builder/commands/sibling.h"
#include "io/help/command_line.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/program.h"
#include "streaming/process/shell.h"

namespace svdag {
namespace {

// Added last: the other commands are its suggested arguments.
void add_help(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("help", "Explain a command or a topic");
  auto subject = std::make_shared<std::string>();
  suggests(app->add_option("SUBJECT", *subject, "A command, or one of the topics below"),
           help_subjects(manual_of(*program)));
  app->footer(list_of_topics());
  app->callback([=] { *command = HelpCommand{manual_of(*program), *subject}; });
}

// The line that continues an interrupted `svdag build` or `svdag batch`, for sh.
std::string resuming_line(int argc, char** argv) {
  std::vector<std::string> words(argv, argv + argc);
  std::erase(words, "--restart");
  // After the command: an option behind "--" would be a file.
  if (std::find(words.begin(), words.end(), "--resume") == words.end())
    words.insert(words.begin() + 2, "--resume");
  return shell_words(words);
}

int run_command(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "export") become_sibling("svdag-export", argv);
  if (argc > 1 && std::string_view(argv[1]) == "import") become_sibling("svdag-import", argv);
  CLI::App app("Bakes triangle scenes as sparse voxel DAGs.", "svdag");
  app.set_version_flag("-V,--version", "svdag " SVDAG_VERSION, "Print the version and exit");
  app.require_subcommand(1);
  Command command;
  add_build(&app, &command);
  add_batch(&app, &command);
  add_merge(&app, &command);
  add_plan(&app, &command);
  add_run(&app, &command);
  add_submit(&app, &command);
  add_info(&app, &command);
  add_query(&app, &command);
  add_edit(&app, &command);
  add_colour(&app, &command);
  add_convert(&app, &command);
  add_pack(&app, &command);
  add_unpack(&app, &command);
  app.add_subcommand("export", "Write the voxels of a .svdag in another format");
  app.add_subcommand("import", "Convert voxels of another program to a .svdag");
  add_help(&app, &command);
  add_examples(&app,
               {"svdag build city.glb -o city.svdag -r 64K", "svdag help build", "svdag help grid"},
               list_of_topics() +
                   "\n\nsvdag-verify checks and renders .svdag files; "
                   "svdag-trace traces rays through them.");
  if (const auto done = read_command_line(&app, argc, argv)) return *done;
  try {
    return std::visit([](const auto& parsed) { return run(parsed); }, command);
  } catch (Interrupted& interrupted) {
    static std::string message;  // lives until it is printed
    const std::string_view name = argc > 1 ? argv[1] : "";
    const bool builds = name == "build" || name == "batch" || name == "colour";
    if (builds && interrupted.resumable && interrupted.resume_message == nullptr) {
      message = "stopped; to continue: " + resuming_line(argc, argv);
      interrupted.resume_message = message.c_str();
    }
    throw;
  }
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  svdag::catch_interrupts();
  // The closure holds only two words, so std::function does not allocate before bad_alloc is
  // caught.
  return svdag::run_program({.name = "svdag", .stopped = "stopped; no work was saved"},
                            [argc, argv] { return svdag::run_command(argc, argv); });
}
