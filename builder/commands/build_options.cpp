// svdag build, and each bake of its lists.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "builder/commands/options.h"
#include "io/help/command_line.h"
#include "io/suggest.h"
#include "io/units.h"
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

void add_measurement_options(CLI::App* app, DescentConfig* descent) {
  constexpr const char* kGroup = "Measurements (the result is the same)";
  app->add_flag_callback(
         "--no-plane-memo", [descent] { descent->plane_memo = descent->patches = false; },
         "Compute every cube, also where a plane repeats")
      ->group(kGroup);
  suggests(
      app->add_option_function<std::string>(
          "--vectors",
          [descent](const std::string& name) { descent->kernels = &kernels_by_name(name); },
          "Instruction set of the inner loops, for example AVX2, or plain (default: the best)"),
      {"plain", "AVX2"})
      ->type_name("NAME")
      ->group(kGroup);
}

double checked_seconds(double seconds) {
  if (!(seconds > 0)) fail_usage("--checkpoint: give more than 0 seconds");
  return seconds;
}

void add_resume_options(CLI::App* app, BuildConfig* build) {
  CLI::Option* resume = app->add_flag_callback(
      "--resume", [build] { build->unfinished = Unfinished::kResume; },
      "Continue an unfinished bake of this output, if there is one (with the same --scratch)");
  app->add_flag_callback(
         "--restart", [build] { build->unfinished = Unfinished::kRestart; },
         "Discard an unfinished bake of this output")
      ->excludes(resume);
  app->add_option_function<double>(
         "--checkpoint", [build](double s) { build->checkpoint = checked_seconds(s); },
         "Save the work of every so many seconds for --resume (default: 30)")
      ->type_name("SECONDS");
}

void add_cache_options(CLI::App* app, CellCacheConfig* config) {
  CLI::Option* cache =
      takes_folder(
          app->add_option(
              "--cache", config->folder,
              "Folder of cells baked before, by any bake: the same cells are not baked again"))
          ->type_name("DIR");
  CLI::Option* size =
      app->add_option_function<std::string>(
             "--cache-size",
             [config](const std::string& s) { config->max_bytes = parse_count(s, "--cache-size"); },
             "Most bytes that the cache may hold; the least used go first (default: 16G)")
          ->type_name("SIZE");
  if (config->folder.empty()) size->needs(cache);  // else the list has one
}

// A step of a plan has to know which options it does not heed.
void remember_options(CLI::App* app, const CLI::App* grid, std::vector<std::string>* given) {
  app->parse_complete_callback([=] {
    for (const CLI::App* options : std::initializer_list<const CLI::App*>{app, grid}) {
      for (const CLI::Option* option : options->get_options()) {
        if (option->count() > 0 && !option->get_lnames().empty())
          given->push_back("--" + option->get_lnames().front());
      }
    }
  });
}

void set_up_build(CLI::App* app, BuildCommandConfig* config) {
  BuildConfig* build = &config->build;
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
  const auto ask_for_no_grid = [grid] { grid->require_option(0, 1); };
  if (build->levels != 0 || build->voxel_size != 0) ask_for_no_grid();  // the list has one
  takes_files(app->add_option_function<std::string>(
                  "--batch",
                  [=](const std::string& list) {  // each bake of the list has these
                    config->batch = list;
                    scene->required(false);
                    output->required(false);
                    ask_for_no_grid();
                  },
                  "Do the bakes of a list, [{\"scene\": ..., \"output\": ..., OPTION: ...}, ...]; "
                  "options beside it hold for bakes that do not say otherwise; --report is of all"),
              {".json"})
      ->type_name("LIST.json");
  app->add_flag("--keep-going", config->keep_going, "Go on with a batch when a bake fails");
  app->add_option_function<size_t>(
         "--shard",
         [=](size_t shard) {  // the plan has a grid, and a place for the run
           if (shard == 0) fail_usage("--shard: 0 is no shard: they are numbered from 1 on");
           config->shard = shard;
           output->required(false);
           ask_for_no_grid();
         },
         "Bake shard I of a plan, from 1 on; one that is there already is kept")
      ->type_name("I");
  app->add_flag("--dry-run", config->dry_run, "Only tell what the bake would take");
  app->add_option_function<std::string>(
         "--part", [build](const std::string& s) { build->part = parse_part(s); },
         "Bake only part I of N of the grid, to a .run; svdag merge joins the runs")
      ->type_name("I/N");
  add_resource_options(app, &build->memory, &config->threads, &build->scratch);
  add_resume_options(app, build);
  add_cache_options(app, &config->cache);
  takes_files(app->add_option("--report", config->report, "Write a report of the bake as JSON"),
              {".json"})
      ->type_name("FILE");
  add_quiet(app, &config->output);
  add_verbose(app, &config->output, "Print seconds per phase, memory, and what was skipped");
  add_progress(app, &config->output);
  add_measurement_options(app, &build->descent);
  remember_options(app, grid, &config->given);
  add_examples(
      app,
      {"svdag build city.glb -o city.svdag -r 64K",
       "svdag build hall.obj props.ply -o hall.svdag -s 0.01 --exclude 'sky*'",
       "svdag build scan.ply -o scan.svdag -r 16K -m 1G --resume"},
      "With --batch LIST.json there is no SCENE and no -o; PLAN --shard I needs nothing else. "
      "svdag help grid, rules and memory tell more.");
}

BuildCommandConfig parse_build(const std::vector<std::string>& arguments,
                               const BuildCommandConfig& defaults) {
  CLI::App app("", "svdag build");
  BuildCommandConfig config = defaults;
  set_up_build(&app, &config);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    fail_usage("help is no part of a bake: svdag build --help has it");
  } catch (const CLI::ParseError& error) {
    fail_usage(explain(app, arguments, error));
  }
  if (!config.batch.empty()) fail_usage("a list of bakes cannot hold another list");
  if (config.shard != 0) fail_usage("a list of bakes cannot hold a shard: svdag run bakes a plan");
  if (config.dry_run) fail_usage("dry-run is of the whole list: give it beside --batch");
  if (config.keep_going) fail_usage("keep-going is of the whole list: give it beside --batch");
  return config;
}

}  // namespace

CLI::App* add_build(CLI::App* program, BuildCommandConfig* config) {
  CLI::App* app = program->add_subcommand("build", "Bake scene files as one .svdag");
  set_up_build(app, config);
  config->parse = parse_build;
  return app;
}

}  // namespace svdag
