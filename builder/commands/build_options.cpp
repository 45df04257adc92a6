// The options of svdag build, on the command line and in the lists of --batch.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>

#include "builder/commands/options.h"
#include "io/help/command_line.h"
#include "io/suggest.h"
#include "io/units.h"
#include "streaming/counts.h"
#include "streaming/error.h"

namespace svdag {
namespace {

CellRange parse_part(const std::string& text) {
  unsigned long long number = 0, count = 0;
  int used = 0;
  if (std::sscanf(text.c_str(), "%llu/%llu%n", &number, &count, &used) != 2 ||
      used != int(text.size()))
    fail_usage("--part: \"" + text + "\" is not I/N, for example 3/8");
  return GridPart::share(number, count);
}

void add_measurement_options(CLI::App* app, FastPaths* fast_paths) {
  constexpr const char* kGroup = "Measurements (the result is the same)";
  app->add_flag_callback(
         "--no-plane-memo", [fast_paths] { fast_paths->plane_memo = fast_paths->patches = false; },
         "Compute every cube, without the memo of repeated planes")
      ->group(kGroup);
  suggests(
      app->add_option_function<std::string>(
          "--vectors",
          [fast_paths](const std::string& name) { fast_paths->kernels = &kernels_by_name(name); },
          "Instruction set of the inner loops, for example AVX2, or plain (default: the best)"),
      {"plain", "AVX2"})
      ->type_name("NAME")
      ->group(kGroup);
}

double checked_seconds(double seconds) {
  if (!(seconds > 0)) fail_usage("--checkpoint: must be more than 0 seconds");
  return seconds;
}

// All options of `svdag build`; command_of() selects the command that they mean.
struct BuildOptions {
  BakeCommand bake;
  std::optional<double> checkpoint;  // seconds
  std::optional<size_t> shard;
  std::string batch;
  bool keep_going = false;
  size_t parallel = 1;
  bool dry_run = false;
  std::set<std::string> given;  // "--rule"
};

void add_resume_options(CLI::App* app, BuildOptions* options) {
  Unfinished* const unfinished = &options->bake.build.unfinished;
  CLI::Option* resume = app->add_flag_callback(
      "--resume", [=] { *unfinished = Unfinished::kResume; },
      "Continue an unfinished bake of this output, if there is one (with the same --scratch)");
  app->add_flag_callback(
         "--restart", [=] { *unfinished = Unfinished::kRestart; },
         "Discard an unfinished bake of this output")
      ->excludes(resume);
  app->add_option_function<double>(
         "--checkpoint", [=](double s) { options->checkpoint = checked_seconds(s); },
         "Save work for --resume every SECONDS seconds (default: 30)")
      ->type_name("SECONDS");
}

void add_cache_options(CLI::App* app, CellCacheConfig* config) {
  CLI::Option* cache =
      takes_folder(
          app->add_option("--cache", config->folder,
                          "Folder that caches baked cells: no bake computes an equal cell again"))
          ->type_name("DIR");
  CLI::Option* size =
      app->add_option_function<std::string>(
             "--cache-size",
             [config](const std::string& s) { config->max_bytes = parse_count(s, "--cache-size"); },
             "Max bytes in the cache; the least recently used go first (default: 16G)")
          ->type_name("SIZE");
  if (config->folder.empty()) size->needs(cache);  // else the defaults of the batch have a cache
}

// The long names of the options that were given, with dashes.
std::set<std::string> given_options(const CLI::App* app, const CLI::App* grid) {
  std::set<std::string> given;
  for (const CLI::App* options : {app, grid}) {
    for (const CLI::Option* option : options->get_options()) {
      if (option->count() > 0 && !option->get_lnames().empty())
        given.insert("--" + option->get_lnames().front());
    }
  }
  return given;
}

void add_options(CLI::App* app, BuildOptions* options) {
  BuildConfig* build = &options->bake.build;
  CLI::Option* scene =
      takes_files(app->add_option("SCENE", build->scene.paths,
                                  "Scene files (several are one scene), or a plan"),
                  kSceneEndings)
          ->required();
  CLI::Option* output = takes_files(app->add_option("-o,--output", build->output,
                                                    "The .svdag, or the .run, to write"),
                                    {".svdag", ".run"})
                            ->required()
                            ->type_name("OUT");
  CLI::Option_group* grid = add_grid_options(app, build);
  const auto grid_is_optional = [grid] { grid->require_option(0, 1); };
  if (build->levels != 0 || build->voxel_size != 0)
    grid_is_optional();  // the defaults of a batch have a grid
  takes_files(
      app->add_option_function<std::string>(
          "--batch",
          [=](const std::string& list) {  // each bake of the list has its own
            options->batch = list;
            scene->required(false);
            output->required(false);
            grid_is_optional();
          },
          "Bake each entry of a list, [{\"scene\": ..., \"output\": ..., OPTION: ...}, ...]; "
          "other options given here are defaults for every bake; --report covers all bakes, and "
          "the next run with it skips those that are up to date"),
      {".json"})
      ->type_name("LIST.json");
  app->add_flag("--keep-going", options->keep_going, "Continue a batch after a bake fails");
  from_to(
      app->add_option("-P,--parallel", options->parallel,
                      "Run up to N bakes of a batch at once; they share --memory and --threads"),
      1, kMaxThreads)
      ->type_name("N");
  app->add_option_function<size_t>(
         "--shard",
         [=](size_t shard) {  // the plan has a grid and an output
           if (shard == 0) fail_usage("--shard 0: shards are numbered from 1");
           options->shard = shard;
           output->required(false);
           grid_is_optional();
         },
         "Bake shard I (from 1) of a plan; a finished one is kept")
      ->type_name("I");
  app->add_flag("--dry-run", options->dry_run,
                "Only predict the time, memory and disk space of the bake");
  app->add_option_function<std::string>(
         "--part", [build](const std::string& s) { build->part = parse_part(s); },
         "Bake only part I of N of the grid, as a .run; svdag merge joins the runs")
      ->type_name("I/N");
  add_layer_options(app, build);
  add_layout(app, &build->layout);
  add_resource_options(app, &build->memory, &options->bake.threads, &build->scratch);
  add_resume_options(app, options);
  add_cache_options(app, &options->bake.cache);
  takes_files(
      app->add_option("--report", options->bake.report,
                      "Write a report of the bake as JSON; -: to stdout, instead of the summary"),
      {".json"})
      ->type_name("FILE");
  app->add_flag("--json", options->bake.output.json,
                "Print the report, or the prediction of --dry-run, as JSON");
  add_no_clobber(app, &options->bake.output.no_clobber);
  add_quiet(app, &options->bake.output);
  add_verbose(app, &options->bake.output, "Print seconds per phase, memory, and what was skipped");
  add_progress(app, &options->bake.output);
  add_measurement_options(app, &build->fast_paths);
  app->parse_complete_callback([=] { options->given = given_options(app, grid); });
  add_examples(app,
               {"svdag build city.glb -o city.svdag -r 64K",
                "svdag build hall.obj props.ply -o hall.svdag -s 0.01 --exclude 'sky*'",
                "svdag build scan.ply -o scan.svdag -r 16K -m 1G --resume"},
               "--batch LIST.json replaces SCENE and -o; PLAN --shard I needs no other option. "
               "See also: svdag help grid, rules, memory.");
}

// Rejects options that a shard would ignore because the plan sets them.
void require_shard_options(const std::set<std::string>& given) {
  static const std::set<std::string> kHonored = {
      "--shard",   "--output",     "--memory", "--threads", "--scratch",  "--resume",
      "--restart", "--checkpoint", "--quiet",  "--verbose", "--progress", "--no-progress"};
  for (const std::string& option : given) {
    if (!kHonored.contains(option))
      fail_usage(option + ": the plan of a shard sets this: leave the option out");
  }
}

ShardCommand shard_of(const BuildOptions& options) {
  const BuildConfig& build = options.bake.build;
  const std::vector<std::string>& paths = build.scene.paths;
  if (paths.size() != 1)
    fail_usage("--shard: takes one plan, " + std::to_string(paths.size()) +
               " paths are given: name only the plan");
  require_shard_options(options.given);
  ShardCommand command;
  command.plan = paths.front();
  command.shard = *options.shard;
  command.step = {build.output, build.memory, build.scratch};
  command.step.checkpoint = options.checkpoint.value_or(0);
  command.step.restart = build.unfinished == Unfinished::kRestart;
  command.threads = options.bake.threads;
  command.output = options.bake.output;
  return command;
}

BatchCommand batch_of(const BuildOptions& options) {
  const BuildConfig& build = options.bake.build;
  if (!build.scene.paths.empty())
    fail_usage("--batch: scenes are in the list: leave " + build.scene.paths.front() + " out");
  if (!build.output.empty()) fail_usage("--batch: outputs are in the list: leave --output out");
  if (options.shard) fail_usage("--batch: a list has no shards: leave --shard out");
  if (build.part) fail_usage("--batch: parts are in the list: leave --part out");
  BatchCommand command{options.batch,   options.bake,        options.given,   options.keep_going,
                       options.dry_run, options.bake.report, options.parallel};
  command.defaults.report.clear();
  if (command.dry_run && options.bake.output.json)
    fail_usage("--json: a batch predicts as text: leave --json out");
  command.json = command.defaults.output.json;
  command.defaults.output.json = false;
  return command;
}

Command command_of(const BuildOptions& parsed) {
  BuildOptions options = parsed;
  if (options.checkpoint) options.bake.build.checkpoint = *options.checkpoint;
  if (options.bake.report == "-") {
    options.bake.report.clear();
    options.bake.output.json = true;
  }
  if (options.parallel > 1 && options.batch.empty())
    fail_usage("--parallel: applies only to --batch");
  if (options.shard && !options.bake.build.scene.paths.empty()) return shard_of(options);
  if (options.dry_run && !options.bake.report.empty())
    fail_usage("--report: --dry-run writes no report: leave --report out");
  if (options.keep_going && options.batch.empty())
    fail_usage("--keep-going: applies only to --batch");
  if (!options.batch.empty()) return batch_of(options);
  if (!options.dry_run) return options.bake;
  return DryRunCommand{options.bake.build, options.bake.threads, options.bake.output};
}

}  // namespace

BakeCommand parse_bake(const std::vector<std::string>& arguments, const BakeCommand& defaults) {
  CLI::App app("", "svdag build");
  BuildOptions options;
  options.bake = defaults;
  add_options(&app, &options);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    fail_usage("a bake in a list cannot have the option help: see svdag build --help");
  } catch (const CLI::ParseError& error) {
    fail_usage(explain(app, arguments, error));
  }
  if (!options.batch.empty()) fail_usage("a list of bakes cannot hold another list");
  if (options.shard) fail_usage("a list of bakes cannot hold a shard: svdag run bakes a plan");
  if (options.dry_run) fail_usage("dry-run applies to the whole list: pass it with --batch");
  if (options.parallel > 1) fail_usage("parallel applies to the whole list: pass it with --batch");
  if (options.keep_going) fail_usage("keep-going applies to the whole list: pass it with --batch");
  if (options.bake.output.json || options.bake.report == "-")
    fail_usage("json: reports go to the file of --report: leave it out");
  if (options.checkpoint) options.bake.build.checkpoint = *options.checkpoint;
  return options.bake;
}

void add_build(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("build", "Bake scene files as one .svdag");
  auto options = std::make_shared<BuildOptions>();
  add_options(app, options.get());
  app->preparse_callback([=](size_t) { *options = {}; });
  app->callback([=] { *command = command_of(*options); });
}

}  // namespace svdag
