// The options of bakes in parts: svdag plan, run, submit and merge.
#include <CLI/CLI.hpp>
#include <memory>

#include "builder/commands/options.h"
#include "io/help/command_line.h"
#include "streaming/counts.h"
#include "streaming/error.h"

namespace svdag {

namespace {

struct MergeOptions {
  MergeCommand merge;
  std::string step;
};

Command command_of(const MergeOptions& options) {
  const auto& [merge, threads, output] = options.merge;
  if (options.step.empty()) return options.merge;
  if (merge.layout != Layout::kPlain)
    fail_usage("--layout: a plan makes plain files: convert its result with svdag convert");
  if (merge.runs.size() != 1)
    fail_usage("--step: takes one plan, " + std::to_string(merge.runs.size()) +
               " paths are given: name only the plan");
  return MergeStepCommand{merge.runs.front(),
                          options.step,
                          {merge.output, merge.memory, merge.scratch},
                          threads,
                          output};
}

}  // namespace

void add_merge(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("merge", "Join the runs of parts of one bake");
  auto options = std::make_shared<MergeOptions>();
  MergeCommand* const config = &options->merge;
  takes_files(app->add_option("RUN", config->merge.runs, "Runs of parts of one bake, or a plan"),
              {".run"})
      ->required();
  CLI::Option* output =
      takes_files(
          app->add_option("-o,--output", config->merge.output,
                          "The .svdag to write, if the runs hold the whole grid, or a larger .run"),
          {".svdag", ".run"})
          ->required()
          ->type_name("OUT");
  app->add_option_function<std::string>(
         "--step",
         [=](const std::string& step) {
           options->step = step;
           output->required(false);
         },
         "Do this merge of a plan; a finished one is kept")
      ->type_name("NAME");
  add_layout(app, &config->merge.layout);
  add_resource_options(app, &config->merge.memory, &config->threads, &config->merge.scratch);
  add_quiet(app, &config->output);
  add_verbose(app, &config->output, "Print seconds per phase, and memory");
  add_progress(app, &config->output);
  add_examples(
      app,
      {"svdag build city.glb -r 64K --part 1/2 -o a.run",
       "svdag build city.glb -r 64K --part 2/2 -o b.run", "svdag merge a.run b.run -o city.svdag"},
      "PLAN --step NAME needs no other option. See also: svdag help farm.");
  app->preparse_callback([=](size_t) { *options = {}; });
  app->callback([=] { *command = command_of(*options); });
}

void add_plan(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("plan", "Divide a bake into jobs for a farm");
  auto config = std::make_shared<PlanCommand>();
  PlanConfig* plan = &config->plan;
  takes_files(
      app->add_option("SCENE", plan->build.scene.paths, "Scene files; several are one scene"),
      kSceneEndings)
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
  add_grid_options(app, &plan->build);
  add_layer_options(app, &plan->build);
  add_resource_options(app, &plan->build.memory, &plan->step_threads, &plan->build.scratch,
                       "PLAN/plan.scratch", "Threads of each shard (default: 1)");
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
  CLI::App* app = program->add_subcommand("run", "Run a plan on this machine");
  auto config = std::make_shared<RunCommand>();
  takes_folder(app->add_option("PLAN", config->plan, "The folder of a plan"))->required();
  from_to(app->add_option("-j,--jobs", config->processes,
                          "Max steps to run at once (default: number of processors)"),
          1, kMaxThreads)
      ->type_name("N");
  takes_folder(
      app->add_option("--scratch", config->scratch, "Folder for data that does not fit in memory"))
      ->type_name("DIR");
  add_quiet(app, &config->output);
  add_progress(app, &config->output);
  add_examples(app, {"svdag run city.plan -j 4"});
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] { *command = *config; });
}

void add_submit(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("submit", "Submit a plan to a farm");
  auto config = std::make_shared<SubmitCommand>();
  takes_folder(app->add_option("PLAN", config->plan, "The folder of a plan"))->required();
  one_of(app->add_option("--engine", config->engine,
                         "slurm (submits jobs) or openjd (writes a template)"),
         {"slurm", "openjd"})
      ->required()
      ->type_name("NAME");
  app->add_flag("--wait", config->wait, "Wait until the plan is done");
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
  app->add_option("OPTION", config->options, "After --: options for the engine");
  add_quiet(app, &config->output);
  add_examples(app, {"svdag submit city.plan --engine slurm --wait -- --partition=bake",
                     "svdag submit city.plan --engine openjd -o city.openjd.json"});
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] { *command = *config; });
}

}  // namespace svdag
