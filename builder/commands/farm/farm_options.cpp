// The options of bakes in parts: svdag plan, run, submit and merge.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "builder/commands/options.h"
#include "io/help/command_line.h"
#include "io/scene/scene_formats.h"
#include "streaming/counts.h"
#include "streaming/error.h"

namespace svdag {

void add_merge(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("merge", "Join the runs of parts of one bake");
  auto config = std::make_shared<MergeCommand>();
  MergeRunsConfig* const merge = &config->merge;
  takes_files(app->add_option("RUN", merge->runs, "Runs of parts of one bake"), {".run"})
      ->required();
  takes_files(app->add_option("-o,--output", merge->output,
                              "The .svdag to write, if the runs hold the whole grid, or a larger "
                              ".run"),
              {".svdag", ".run"})
      ->required()
      ->type_name("OUT");
  add_layout(app, &merge->layout);
  add_resource_options(app, &merge->memory, &config->threads, &merge->scratch);
  add_quiet(app, &config->output);
  add_verbose(app, &config->output, "Print seconds per phase, and memory");
  add_progress(app, &config->output);
  add_examples(
      app,
      {"svdag build city.glb -r 64K --part 1/2 -o a.run",
       "svdag build city.glb -r 64K --part 2/2 -o b.run", "svdag merge a.run b.run -o city.svdag"},
      "See also: svdag help farm.");
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] { *command = *config; });
}

void add_plan(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("plan", "Divide a bake into jobs for a farm");
  auto config = std::make_shared<PlanCommand>();
  PlanConfig* plan = &config->plan;
  takes_files(
      app->add_option("SCENE", plan->build.scene.paths, "Scene files; several are one scene"),
      scene_endings())
      ->required();
  takes_folder(app->add_option("-o,--output", plan->folder, "The folder of the plan, to create"))
      ->required()
      ->type_name("PLAN");
  from_to(app->add_option("--shards", plan->shards, "Number of jobs to divide the bake into"), 1,
          100000)
      ->required()
      ->type_name("N");
  from_to(app->add_option("--fan-in", plan->fan_in,
                          "Max number of runs that one merge reads (default: 16)"),
          2, 1000)
      ->type_name("N");
  add_frames(app, &plan->build);
  add_grid_options(app, &plan->build);
  add_layer_options(app, &plan->build);
  add_colours(app, &plan->build.colours);
  add_resource_options(app, &plan->build.memory, &plan->step_threads, &plan->build.scratch,
                       "PLAN/plan.scratch",
                       "Threads of each shard, and of the colour pass (default: 1)");
  add_quiet(app, &config->output);
  add_verbose(app, &config->output, "Print a table of the steps");
  add_progress(app, &config->output);
  add_examples(app,
               {"svdag plan city.glb -r 64K --shards 16 -o city.plan", "svdag run city.plan -j 4"},
               "-m limits the planning and each step. See also: svdag help farm.");
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] { *command = *config; });
}

void add_run(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("run", "Run a plan on this machine, or one of its steps");
  auto config = std::make_shared<StepCommand>();
  takes_folder(app->add_option("PLAN", config->plan, "The folder of a plan"))->required();
  from_to(app->add_option("-j,--jobs", config->threads,
                          "Max steps to run at once (default: number of processors); with --step, "
                          "its threads (default: as planned)"),
          1, kMaxThreads)
      ->type_name("N");
  takes_folder(app->add_option("--scratch", config->step.scratch,
                               "Folder for data that does not fit in memory"))
      ->type_name("DIR");
  add_quiet(app, &config->output);
  add_progress(app, &config->output);
  CLI::Option* const step =
      takes_files(app->add_option("--step", config->name,
                                  "Only this step (svdag info --levels lists them); a finished "
                                  "one is kept, a stopped shard or colour pass continues"),
                  {"*"})
          ->type_name("NAME");
  takes_files(app->add_option("-o,--output", config->step.output,
                              "The .run or .svdag to write (default: that of the plan)"),
              {".run", ".svdag"})
      ->type_name("OUT");
  add_memory_budget(app, &config->step.memory);
  app->get_option("--memory")->description("Memory budget (default: as planned)");
  add_checkpoint(app, &config->step.checkpoint);
  app->add_flag("--keep", config->step.keep,
                "Keep the runs, which the last step removes when the output is done");
  app->add_flag("--json", config->output.json, "Print every step with its figures as JSON");
  app->add_flag("--restart", config->step.restart, "Discard the saved work of a stopped step");
  add_verbose(app, &config->output, "Print seconds and memory beside those of the plan");
  for (const char* const option :
       {"--output", "--memory", "--checkpoint", "--restart", "--verbose"})
    app->get_option(option)->needs(step);
  add_examples(app, {"svdag run city.plan -j 4", "svdag run city.plan --step shard-3"});
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] {
    if (step->count() > 0)
      *command = *config;
    else
      *command = RunCommand{config->plan, config->threads, config->step.scratch, config->step.keep,
                            config->output};
  });
}

namespace {

// Adds --engine with a row of kFarmEngines per choice.
void add_engine(CLI::App* app, const FarmEngine** engine) {
  std::vector<std::string> names;
  std::string text;
  for (const FarmEngine& each : kFarmEngines) {
    names.push_back(each.name);
    text += (text.empty() ? "" : " or ") + std::string(each.name) + " (" + each.what + ")";
  }
  const auto choose = [=](const std::string& name) { *engine = &farm_engine(name); };
  one_of(app->add_option_function<std::string>("--engine", choose, text), names)
      ->required()
      ->type_name("NAME");
}

// Rejects options that the chosen engine would ignore. Engine options begin with a dash: any other
// word is a second plan, which must not be passed to the engine.
void reject_options_of_other_engines(const CLI::App& app, const SubmitCommand& command) {
  const std::vector<std::string>& words = command.config.options;
  if (!words.empty() && !words.front().starts_with('-'))
    fail_usage(words.front() +
               ": one plan is submitted at a time; options for the engine begin with a dash and "
               "follow --");
  const std::vector<std::string>& own = command.engine->options;
  for (const FarmEngine& other : kFarmEngines) {
    for (const std::string& option : other.options) {
      if (app.count(option) > 0 && std::ranges::find(own, option) == own.end())
        fail_usage("--engine " + std::string(command.engine->name) + ' ' + command.engine->what +
                   ": leave " + option + " out, which is for " + other.name);
    }
  }
}

}  // namespace

void add_submit(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("submit", "Submit a plan to a farm");
  auto submit = std::make_shared<SubmitCommand>();
  SubmitConfig* const config = &submit->config;
  takes_folder(app->add_option("PLAN", submit->plan, "The folder of a plan"))->required();
  add_engine(app, &submit->engine);
  app->add_flag("--wait", config->wait, "slurm: wait until the plan is done");
  takes_files(app->add_option("--program", config->program,
                              "svdag on the other machines (default: this file)"),
              {"*"})
      ->type_name("FILE");
  takes_files(app->add_option("-o,--output", config->template_path,
                              "openjd: the template to write (default: PLAN/openjd.json)"),
              {".json"})
      ->type_name("FILE");
  takes_folder(
      app->add_option("--scratch", config->scratch,
                      "Folder on the machines for spilled data (a relative path begins here)"))
      ->type_name("DIR");
  app->add_flag("--keep", config->keep,
                "Keep the runs, which the last step removes when the output is done");
  app->add_option("OPTION", config->options, "slurm: after --, options for sbatch");
  app->add_flag("-q,--quiet", config->quiet, "Print errors only");
  add_examples(app, {"svdag submit city.plan --engine slurm --wait -- --partition=bake",
                     "svdag submit city.plan --engine openjd -o city.openjd.json"});
  app->preparse_callback([=](size_t) { *submit = {}; });
  app->callback([=] {
    reject_options_of_other_engines(*app, *submit);
    *command = *submit;
  });
}

}  // namespace svdag
