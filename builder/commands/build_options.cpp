// The options of svdag build, on the command line and in lists, and of svdag batch.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <set>
#include <utility>

#include "builder/commands/options.h"
#include "io/help/command_line.h"
#include "io/scene/scene_formats.h"
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

// What the lines of svdag build and svdag batch have in common.
struct BakeOptions {
  BakeCommand bake;
  bool dry_run = false;
};

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

// The options of every bake. Returns the group of -r and -s, of which one is required.
CLI::Option_group* add_bake_options(CLI::App* app, BakeCommand* bake) {
  BuildConfig* const build = &bake->build;
  CLI::Option_group* const grid = add_grid_options(app, build);
  add_layer_options(app, build);
  add_palette(app, &build->palette);
  add_colours(app, &build->colours);
  add_layout(app, &build->layout);
  add_resource_options(app, &build->memory, &bake->threads, &build->scratch);
  add_resume_options(app, &build->unfinished, &build->checkpoint);
  add_cache_options(app, &bake->cache);
  add_no_clobber(app, &bake->output.no_clobber);
  add_quiet(app, &bake->output);
  add_verbose(app, &bake->output, "Print seconds per phase, memory, and what was skipped");
  add_progress(app, &bake->output);
  add_measurement_options(app, &build->fast_paths);
  return grid;
}

// Adds --dry-run, --report and --json. The report "-" is --json.
CLI::Option* add_result_options(CLI::App* app, BakeOptions* options, const char* dry_run_text,
                                const char* report_text, const char* json_text) {
  BakeCommand* const bake = &options->bake;
  CLI::Option* const dry_run = app->add_flag("--dry-run", options->dry_run, dry_run_text);
  takes_files(app->add_option_function<std::string>(
                  "--report",
                  [bake](const std::string& path) {
                    if (path == "-") bake->output.json = true;
                    bake->report = path == "-" ? "" : path;
                  },
                  report_text),
              {".json"})
      ->excludes(dry_run)
      ->type_name("FILE");
  return app->add_flag("--json", bake->output.json, json_text);
}

void add_build_options(CLI::App* app, BakeOptions* options) {
  BuildConfig* const build = &options->bake.build;
  takes_files(app->add_option("SCENE", build->scene.paths, "Scene files; several are one scene"),
              scene_endings())
      ->required();
  CLI::Option* const output = takes_files(app->add_option("-o,--output", build->output,
                                                          "The .svdag, or the .run, to write"),
                                          {".svdag", ".run"})
                                  ->required()
                                  ->type_name("OUT");
  add_frames(app, build);
  CLI::Option_group* const grid = add_bake_options(app, &options->bake);
  // The defaults of a batch may have a grid.
  if (build->levels != 0 || build->voxel_size != 0) grid->require_option(0, 1);
  app->add_option_function<std::string>(
         "--part", [build](const std::string& s) { build->part = parse_part(s); },
         "Bake only part I of N of the grid, as a .run; svdag merge joins the runs")
      ->type_name("I/N");
  add_result_options(app, options, "Only predict the time, memory and disk space of the bake",
                     "Write a report of the bake as JSON; -: to stdout, instead of the summary",
                     "Print the report, or the prediction of --dry-run, as JSON");
  app->get_option("--dry-run")->each([output](const std::string&) { output->required(false); });
}

// The long names of the flags that were given.
std::set<std::string> given_flags(const CLI::App& app) {
  std::set<std::string> given;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() == 0 && option->count() > 0)
      given.insert(option->get_lnames().front());
  }
  return given;
}

}  // namespace

BakeCommand parse_bake(const std::vector<std::string>& arguments, const BakeCommand& defaults) {
  CLI::App app("", "svdag build");
  BakeOptions options;
  options.bake = defaults;
  add_build_options(&app, &options);
  constexpr const char* kOfTheList =
      "help, dry-run and json are not options of one bake in a list: give them to svdag batch";
  try {
    parse_words(&app, arguments);
  } catch (const CLI::CallForHelp&) {
    fail_usage(kOfTheList);
  }
  if (options.dry_run || options.bake.output.json) fail_usage(kOfTheList);
  return options.bake;
}

void add_build(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("build", "Bake scene files as one .svdag");
  auto options = std::make_shared<BakeOptions>();
  add_build_options(app, options.get());
  add_examples(app,
               {"svdag build city.glb -o city.svdag -r 64K",
                "svdag build hall.obj props.ply -o hall.svdag -s 0.01 --exclude 'sky*'",
                "svdag build scan.ply -o scan.svdag -r 16K -m 1G --resume"},
               "See also: svdag help grid, rules, memory.");
  app->preparse_callback([=](size_t) { *options = {}; });
  app->callback([=] {
    BakeCommand& bake = options->bake;
    if (options->dry_run && bake.build.output.empty()) bake.build.output = "dry-run.svdag";
    if (options->dry_run)
      *command = DryRunCommand{bake.build, bake.threads, bake.output};
    else
      *command = bake;
  });
}

void add_batch(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("batch", "Bake each entry of a list");
  struct BatchOptions : BakeOptions {
    BatchCommand batch;
  };
  auto options = std::make_shared<BatchOptions>();
  BatchCommand* const batch = &options->batch;
  takes_files(app->add_option("LIST", batch->list,
                              "The bakes, as JSON: [{\"scene\": ..., \"output\": ..., OPTION: "
                              "...}, ...] with the options of svdag build"),
              {".json"})
      ->required();
  app->add_flag("--keep-going", batch->keep_going, "Continue after a bake fails");
  from_to(app->add_option("-P,--parallel", batch->parallel,
                          "Run up to N bakes at once; they share --memory and --threads"),
          1, kMaxThreads)
      ->type_name("N");
  add_bake_options(app, &options->bake)->require_option(0, 1);
  add_result_options(app, options.get(),
                     "Only predict the time, memory and disk space of each bake",
                     "Write a report of all bakes as JSON (-: to stdout); the next run with it "
                     "skips those that are up to date",
                     "Print the report of all bakes as JSON")
      ->excludes(app->get_option("--dry-run"));
  add_examples(app,
               {"svdag batch list.json --report done.json --keep-going",
                "svdag batch list.json --rule thin -P 2 -m 8G"},
               "All other options are defaults of the bakes. See also: svdag build --help.");
  app->preparse_callback([=](size_t) { *options = {}; });
  app->callback([=] {
    BatchCommand given = *batch;
    given.defaults = options->bake;
    given.flags = given_flags(*app);
    given.dry_run = options->dry_run;
    given.report = std::exchange(given.defaults.report, "");
    given.json = std::exchange(given.defaults.output.json, false);
    *command = std::move(given);
  });
}

}  // namespace svdag
