// The program `svdag`: the command line.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>

#include "builder/commands/commands.h"
#include "builder/commands/sibling.h"
#include "io/suggest.h"
#include "io/units.h"
#include "streaming/interrupt.h"
#include "streaming/program.h"

namespace svdag {
namespace {

void add_output_options(CLI::App* app, OutputConfig* output) {
  app->add_flag("-q,--quiet", output->quiet, "Print errors only");
  app->add_flag("-v,--verbose", output->verbose, "Print seconds and memory per phase");
  app->add_flag_callback(
      "--progress", [output] { output->progress = Progress::Mode::kOn; },
      "Show progress even if stderr is no terminal");
  app->add_flag_callback(
      "--no-progress", [output] { output->progress = Progress::Mode::kOff; },
      "Never show progress");
}

void add_scene_options(CLI::App* app, NameFilter* names, bool* skip_invalid) {
  app->add_option("--include", names->include,
                  "Only parts whose name matches a pattern (*, ?, [..])")
      ->type_name("PATTERN");
  app->add_option("--exclude", names->exclude, "No part whose name matches a pattern")
      ->type_name("PATTERN");
  app->add_flag("--skip-invalid", *skip_invalid, "Drop triangles with NaN or infinite coordinates");
}

CellRange parse_part(const std::string& text) {
  unsigned long long number = 0, count = 0;
  int used = 0;
  if (std::sscanf(text.c_str(), "%llu/%llu%n", &number, &count, &used) != 2 ||
      used != int(text.size()))
    fail_usage("--part: \"" + text + "\" is not I/N, for example 3/8");
  return Part::share(number, count);
}

void add_measurement_options(CLI::App* app, DescentConfig* descent) {
  constexpr const char* kGroup = "Measurements (the result is the same)";
  app->add_flag_callback(
         "--no-plane-memo", [descent] { descent->plane_memo = descent->patches = false; },
         "Compute every cube, also where a plane repeats")
      ->group(kGroup);
  app->add_option_function<std::string>(
         "--vectors",
         [descent](const std::string& name) { descent->kernels = &kernels_by_name(name); },
         "Instruction set of the inner loops, for example AVX2, or plain (default: the best)")
      ->type_name("NAME")
      ->group(kGroup);
}

// Memory, threads and disk; the result is the same with any of them.
void add_resource_options(CLI::App* app, uint64_t* memory, size_t* threads, std::string* scratch) {
  app->add_option_function<std::string>(
         "-m,--memory", [memory](const std::string& s) { *memory = parse_count(s, "--memory"); },
         "Memory budget, for example 4G (default: half of the machine)")
      ->type_name("SIZE");
  app->add_option("-j,--threads", *threads, "Threads (default: all processors)")
      ->check(CLI::Range(size_t(1), size_t(1024)));
  app->add_option("--scratch", *scratch,
                  "Folder for what does not fit in memory (default: OUT.scratch)")
      ->type_name("DIR");
}

void add_resume_options(CLI::App* app, BuildConfig* build) {
  CLI::Option* resume = app->add_flag_callback(
      "--resume", [build] { build->unfinished = Unfinished::kResume; },
      "Continue an unfinished bake of this output, if there is one");
  app->add_flag_callback(
         "--restart", [build] { build->unfinished = Unfinished::kRestart; },
         "Discard an unfinished bake of this output")
      ->excludes(resume);
  app->add_option("--checkpoint", build->checkpoint,
                  "Save the work of every so many seconds for --resume (default: 30)")
      ->check(CLI::PositiveNumber)
      ->type_name("SECONDS");
}

void add_cache_options(CLI::App* app, CellCacheConfig* config) {
  CLI::Option* cache =
      app->add_option(
             "--cache", config->folder,
             "Folder of cells baked before, by any bake: the same cells are not baked again")
          ->type_name("DIR");
  app->add_option_function<std::string>(
         "--cache-size",
         [config](const std::string& s) { config->most_bytes = parse_count(s, "--cache-size"); },
         "Most that the cache may hold; the least used goes first (default: 16G)")
      ->needs(cache)
      ->type_name("SIZE");
}

double checked_voxel_size(double size) {
  if (size == 0) fail_usage("--voxel-size: 0 is not a size");
  return size;
}

CLI::Option_group* add_grid_options(CLI::App* app, BuildConfig* build) {
  CLI::Option_group* grid = app->add_option_group("grid");
  grid->add_option_function<std::string>(
          "-r,--resolution", [build](const std::string& s) { build->levels = parse_resolution(s); },
          "Voxels along the longest side: 8 ... 1M, a power of two")
      ->type_name("N");
  grid->add_option_function<double>(
          "-s,--voxel-size", [build](double s) { build->voxel_size = checked_voxel_size(s); },
          "Side of a voxel in scene units; voxel planes at (k + 1/2) times it")
      ->type_name("S");
  grid->require_option(1);
  app->add_option_function<std::string>(
         "--bounds", [build](const std::string& s) { build->bounds = parse_bounds(s); },
         "Bake only this box, in scene units")
      ->type_name("x0,y0,z0,x1,y1,z1");
  static const std::map<std::string, Rule> kRules = {{"conservative", Rule::kConservative},
                                                     {"thin", Rule::kThin}};
  app->add_option(
         "--rule", build->descent.rule,
         "conservative (default): every voxel that a triangle touches; thin: 6-separating, "
         "about 1.8 times fewer voxels")
      ->transform(CLI::CheckedTransformer(kRules).description(""))
      ->type_name("RULE");
  add_scene_options(app, &build->scene.names, &build->scene.skip_invalid);
  return grid;
}

void set_up_build(CLI::App* app, BuildCommandConfig* config) {
  BuildConfig* build = &config->build;
  CLI::Option* scene =
      app->add_option("SCENE", build->scene.paths, "Scene files (several are one scene), or a plan")
          ->required();
  CLI::Option* output =
      app->add_option("-o,--output", build->output, "The .svdag, or the .run, to write")
          ->required();
  CLI::Option_group* grid = add_grid_options(app, build);
  app->add_option_function<std::string>(
         "--batch",
         [=](const std::string& list) {  // each bake of the list has these
           config->batch = list;
           scene->required(false);
           output->required(false);
           grid->require_option(0);
         },
         "Do the bakes of a list, [{\"scene\": ..., \"output\": ..., OPTION: ...}, ...]; --report "
         "is "
         "of all")
      ->type_name("LIST.json");
  app->add_flag("--keep-going", config->keep_going, "Go on with a batch when a bake fails");
  app->add_option_function<size_t>(
         "--shard",
         [=](size_t shard) {  // the plan has a grid, and a place for the run
           config->shard = shard;
           output->required(false);
           grid->require_option(0);
         },
         "Bake shard I of a plan; one that is there already is kept")
      ->check(CLI::PositiveNumber)
      ->type_name("I");
  app->add_flag("--dry-run", config->dry_run, "Only tell what the bake would take");
  app->add_option_function<std::string>(
         "--part", [build](const std::string& s) { build->part = parse_part(s); },
         "Bake only part I of N of the grid, to a .run; svdag merge joins the runs")
      ->type_name("I/N");
  add_resource_options(app, &build->memory, &config->threads, &build->scratch);
  add_resume_options(app, build);
  add_cache_options(app, &config->cache);
  app->add_option("--report", config->report, "Write a report of the bake as JSON")
      ->type_name("FILE");
  add_output_options(app, &config->output);
  add_measurement_options(app, &build->descent);
  app->footer(
      "Examples:\n"
      "  svdag build city.glb -o city.svdag -r 64K\n"
      "  svdag build hall.obj props.ply -o hall.svdag --voxel-size 0.01 --exclude 'sky*'");
}

BuildCommandConfig parse_build(const std::vector<std::string>& arguments) {
  CLI::App app("", "svdag build");
  BuildCommandConfig config;
  set_up_build(&app, &config);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {
    fail_usage(error.what());
  }
  if (!config.batch.empty()) fail_usage("a list of bakes cannot hold another list");
  return config;
}

void set_up_merge(CLI::App* app, MergeCommandConfig* config) {
  app->add_option("RUN", config->merge.runs, "Runs of parts of one bake, or a plan")->required();
  CLI::Option* output =
      app->add_option("-o,--output", config->merge.output,
                      "The .svdag to write, if the runs hold the whole grid, or a larger .run")
          ->required();
  app->add_option_function<std::string>(
         "--step",
         [=](const std::string& step) {
           config->step = step;
           output->required(false);
         },
         "Do this merge of a plan; one that is done already is kept")
      ->type_name("NAME");
  add_resource_options(app, &config->merge.memory, &config->threads, &config->merge.scratch);
  add_output_options(app, &config->output);
  app->footer(
      "Examples:\n"
      "  svdag build city.glb -r 64K --part 1/2 -o a.run\n"
      "  svdag build city.glb -r 64K --part 2/2 -o b.run\n"
      "  svdag merge a.run b.run -o city.svdag");
}

void set_up_plan(CLI::App* app, PlanCommandConfig* config) {
  PlanConfig* plan = &config->plan;
  app->add_option("SCENE", plan->build.scene.paths, "Scene files; several files are one scene")
      ->required();
  app->add_option("-o,--output", plan->folder, "The folder of the plan, to be made")->required();
  app->add_option("--shards", plan->shards, "Into how many jobs the bake is cut")
      ->required()
      ->check(CLI::Range(size_t(1), size_t(100000)));
  app->add_option("--fan-in", plan->fan_in, "Runs that one merge reads, at most (default: 16)")
      ->check(CLI::Range(size_t(2), size_t(1000)));
  add_grid_options(app, &plan->build);
  add_resource_options(app, &plan->build.memory, &plan->step_threads, &plan->build.scratch);
  add_output_options(app, &config->output);
  app->footer(
      "-m bounds the planning and each step; -j are the threads of a shard (default: 1). Example:\n"
      "  svdag plan city.glb -r 64K --shards 16 -o city.plan\n"
      "  svdag run city.plan -j 4");
}

void set_up_run(CLI::App* app, RunCommandConfig* config) {
  app->add_option("PLAN", config->plan, "The folder of a plan")->required();
  app->add_option("-j,--jobs", config->processes,
                  "Steps at once (default: as many as there are processors)")
      ->check(CLI::Range(size_t(1), size_t(1024)));
  app->add_option("--scratch", config->scratch, "Folder for what does not fit in memory")
      ->type_name("DIR");
  add_output_options(app, &config->output);
}

void set_up_submit(CLI::App* app, SubmitConfig* config) {
  app->add_option("PLAN", config->plan, "The folder of a plan")->required();
  app->add_option("--engine", config->engine, "slurm (submits jobs) or openjd (writes a template)")
      ->required()
      ->check(CLI::IsMember({"slurm", "openjd"}));
  app->add_flag("--wait", config->wait, "Wait until the plan is done");
  app->add_option("--program", config->program, "svdag on the other machines (default: this file)");
  app->add_option("-o,--output", config->template_path,
                  "Of openjd: the template (default: PLAN/openjd.json)");
  app->add_option("--scratch", config->scratch, "Folder on the machines for what is spilled")
      ->type_name("DIR");
  app->add_option("OPTION", config->options, "Behind --: options for the engine");
  add_output_options(app, &config->output);
  app->footer("Example: svdag submit city.plan --engine slurm --wait -- --partition=bake");
}

void set_up_info(CLI::App* app, InfoConfig* config) {
  app->add_option("FILE", config->paths, "A .svdag or .run file, or the files of a scene")
      ->required();
  app->add_flag("--json", config->json, "Print JSON");
  app->add_flag("--levels", config->levels, "Print a table of the levels of a .svdag");
  add_scene_options(app, &config->names, &config->skip_invalid);
  app->add_option_function<std::string>(
         "-m,--memory",
         [config](const std::string& s) { config->memory = parse_count(s, "--memory"); },
         "Memory budget (default: half of the machine)")
      ->type_name("SIZE");
  app->footer("Examples:\n  svdag info city.svdag --levels\n  svdag info city.glb");
}

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
  CLI::App* build_app = app.add_subcommand("build", "Bake scene files as one .svdag");
  CLI::App* merge_app = app.add_subcommand("merge", "Join the runs of parts of one bake");
  CLI::App* plan_app = app.add_subcommand("plan", "Cut a bake into jobs for a farm");
  CLI::App* run_app = app.add_subcommand("run", "Run a plan on this machine");
  CLI::App* submit_app = app.add_subcommand("submit", "Hand a plan to a farm");
  CLI::App* info_app = app.add_subcommand("info", "Tell what a .svdag, a run or a scene contains");
  app.add_subcommand("export", "Write the voxels of a .svdag in another format");
  app.add_subcommand("import", "Make a .svdag of the voxels of another program");
  set_up_build(build_app, &build);
  build.parse = parse_build;
  set_up_merge(merge_app, &merge);
  set_up_plan(plan_app, &plan);
  set_up_run(run_app, &run);
  set_up_submit(submit_app, &submit);
  set_up_info(info_app, &info);
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
