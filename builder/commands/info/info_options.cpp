// The options of svdag info and svdag query.
#include <CLI/CLI.hpp>
#include <memory>

#include "builder/commands/options.h"
#include "io/help/command_line.h"
#include "io/scene/scene_formats.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {

void add_info(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("info", "Describe a .svdag, a run, a plan or a scene");
  auto config = std::make_shared<InfoCommand>();
  std::vector<std::string> endings = scene_endings();
  endings.insert(endings.begin(), {".svdag", ".run"});
  takes_files(app->add_option("FILE", config->scene.paths,
                              "A .svdag or .run file, a plan, or the files of a scene"),
              endings)
      ->required();
  app->add_flag("--json", config->json, "Print JSON");
  app->add_flag("--levels", config->levels,
                "Print a table of the levels of a .svdag, or of the steps of a plan");
  app->add_flag("--layers", config->layers,
                "Print a table of the layers of a .svdag; own nodes are those of no other layer");
  app->add_flag("--parts", config->parts,
                "Print the names of a scene's parts, for use with --include");
  add_scene_options(app, &config->scene);
  add_memory_budget(app, &config->memory);
  add_examples(app, {"svdag info city.svdag --levels", "svdag info city.glb"});
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] { *command = *config; });
}

void add_query(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("query", "Look up points in a .svdag");
  auto config = std::make_shared<QueryCommand>();
  takes_files(app->add_option("FILE", config->file, "The .svdag"), {".svdag"})->required();
  CLI::Option* nearest =
      app->add_flag("--nearest", config->nearest, "Find the set voxel nearest to each point");
  const auto read = [=](double given) {
    if (!(given >= 0)) fail_usage("--max-distance: must be 0 or more");
    config->max_distance = given;
  };
  app->add_option_function<double>("--max-distance", read,
                                   "Find voxels up to this distance, in world units")
      ->type_name("D")
      ->needs(nearest);
  add_examples(
      app, {"svdag query city.svdag < points.txt", "svdag query city.svdag --nearest < points.txt"},
      "Reads points from standard input, one per line: x y z in world units. For each it "
      "prints \"set\" and the voxel, \"empty\" and the largest empty cube of the octree "
      "around the point, both as level (of the octree; the last is that of voxels) and "
      "box, or \"outside\" if the point is not in the grid. With --nearest it prints "
      "\"near\", the distance to the closed cube of the nearest voxel, and its box, or "
      "\"none\". In a file with colours, that of a voxel follows, \"#rrggbb\" or \"none\".");
  app->allow_extras();  // points, most likely
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] {
    std::string words;
    for (const std::string& word : app->remaining()) words += (words.empty() ? "" : " ") + word;
    if (!words.empty())
      fail_usage("points are read from standard input: echo " + words + " | svdag query " +
                 config->file);
    *command = *config;
  });
}

}  // namespace svdag
