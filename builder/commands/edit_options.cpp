// The options of svdag edit, colour, convert, pack and unpack.
#include <CLI/CLI.hpp>
#include <memory>

#include "builder/commands/options.h"
#include "io/help/command_line.h"
#include "io/scene/scene_formats.h"
#include "io/units.h"
#include "streaming/counts.h"
#include "streaming/error.h"

namespace svdag {
namespace {

void add_counts_json(CLI::App* app, OutputConfig* output) {
  app->add_flag("--json", output->json, "Print counts and content hash as JSON");
}

}  // namespace

void add_edit(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("edit", "Combine, crop or coarsen .svdag files");
  auto config = std::make_shared<EditCommand>();
  EditConfig* const edit = &config->edit;
  takes_files(app->add_option("A", edit->first, "The .svdag to edit"), {".svdag"})->required();
  takes_files(app->add_option("B", edit->second,
                              "A second one in the same place: equal resolution, corner, voxel "
                              "size and rule"),
              {".svdag"});
  takes_files(app->add_option("-o,--output", edit->output, "The .svdag to write"), {".svdag"})
      ->required()
      ->type_name("OUT");
  CLI::Option_group* operations = app->add_option_group("Operation");
  const auto add_operation = [&](const char* name, SetOperation operation, const char* text) {
    operations->add_flag_callback(
        name, [=] { edit->operation = operation; }, text);
  };
  add_operation("--union", SetOperation::kUnion, "Voxels of A or B");
  add_operation("--intersection", SetOperation::kIntersection, "Voxels of A and B");
  add_operation("--difference", SetOperation::kDifference, "Voxels of A that are not of B");
  operations->require_option(0, 1);
  add_selection(app, &edit->selection);
  add_layout(app, &edit->selection.layout);
  add_no_clobber(app, &config->output.no_clobber);
  add_resource_options(app, &edit->memory, &config->threads, &edit->scratch);
  add_counts_json(app, &config->output);
  add_quiet(app, &config->output);
  add_examples(app, {"svdag edit city.svdag -o coarse.svdag --level 10",
                     "svdag edit city.svdag -o block.svdag --bounds=0,0,0,50,50,50",
                     "svdag edit new.svdag old.svdag -o added.svdag --difference"});
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] { *command = *config; });
}

void add_colour(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("colour", "Add the colours of its scene to a .svdag");
  auto config = std::make_shared<ColourCommand>();
  ColourFileConfig* const colours = &config->colours;
  takes_files(app->add_option("FILE", colours->file, "The .svdag to colour"), {".svdag"})
      ->required();
  takes_files(app->add_option("SCENE", colours->scene.paths, "The scene files it was built of"),
              scene_endings())
      ->required();
  takes_files(app->add_option("-o,--output", colours->output, "The .svdag to write"), {".svdag"})
      ->required()
      ->type_name("OUT");
  add_colour_options(app, [colours]() -> ColourPassConfig& { return colours->pass; });
  add_scene_options(app, &colours->scene);
  add_resource_options(app, &colours->memory, &config->threads, &colours->scratch);
  add_resume_options(app, &colours->unfinished, &colours->checkpoint);
  add_no_clobber(app, &config->output.no_clobber);
  add_quiet(app, &config->output);
  add_progress(app, &config->output);
  add_examples(app, {"svdag colour truck.svdag truck.glb -o painted.svdag",
                     "svdag colour truck.svdag truck.glb -o exact.svdag --colour-error 0"});
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] { *command = *config; });
}

void add_convert(CLI::App* program, Command* command) {
  CLI::App* app =
      program->add_subcommand("convert", "Write a .svdag in another layout, or one of its layers");
  auto config = std::make_shared<ConvertCommand>();
  takes_files(app->add_option("FILE", config->file, "The .svdag to convert"), {".svdag"})
      ->required();
  takes_files(app->add_option("-o,--output", config->output_path, "The .svdag to write"),
              {".svdag"})
      ->required()
      ->type_name("OUT");
  add_layout(app, &config->selection.layout);
  add_selection(app, &config->selection);
  app->add_flag("--no-colours", config->selection.without_colours,
                "Leave out the colours: the bytes of the file before they were added");
  add_palette(app, &config->selection.palette);
  add_no_clobber(app, &config->output.no_clobber);
  add_memory_budget(app, &config->memory);
  takes_folder(
      app->add_option("--scratch", config->scratch,
                      "Folder for data that does not fit in memory (default: that of OUT)"))
      ->type_name("DIR");
  add_counts_json(app, &config->output);
  add_quiet(app, &config->output);
  add_examples(app, {"svdag convert city.svdag -o small.svdag --layout compact",
                     "svdag convert city.svdag -o roofs.svdag --layer roof"});
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] {
    if (app->count("--layout") == 0 && config->selection.is_everything() &&
        !config->selection.without_colours)
      fail_usage("convert: give --layout, --layer, --level, --bounds, --palette or --no-colours");
    if (app->count("--layout") == 0 &&
        (config->selection.without_colours || !config->selection.palette.empty()))
      config->keeps_layout = true;
    *command = *config;
  });
}

namespace {

// The options that svdag pack and unpack share.
template <class Config>
void add_pack_resources(CLI::App* app, Config* config) {
  add_memory_budget(app, &config->memory);
  from_to(app->add_option("-j,--threads", config->threads, "Threads (default: all processors)"), 1,
          kMaxThreads)
      ->type_name("N");
  add_no_clobber(app, &config->output.no_clobber);
  add_counts_json(app, &config->output);
  add_quiet(app, &config->output);
}

}  // namespace

void add_pack(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("pack", "Compress a .svdag for shipping");
  auto config = std::make_shared<PackCommand>();
  takes_files(app->add_option("FILE", config->file, "The .svdag to pack"), {".svdag"})->required();
  takes_files(app->add_option("-o,--output", config->output_path, "The .pack to write"), {".pack"})
      ->required()
      ->type_name("OUT");
  from_to(app->add_option("--level", config->level, "Level of zstd (default: 5)"), 1, kMaxPackLevel)
      ->type_name("N");
  add_selection(app, &config->selection, false);
  add_pack_resources(app, config.get());
  add_examples(app, {"svdag pack city.svdag -o city.svdag.pack"});
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] { *command = *config; });
}

void add_unpack(CLI::App* program, Command* command) {
  CLI::App* app = program->add_subcommand("unpack", "Write the .svdag of a .pack");
  auto config = std::make_shared<UnpackCommand>();
  takes_files(app->add_option("FILE", config->file, "The .pack to unpack"), {".pack"})->required();
  takes_files(app->add_option("-o,--output", config->output_path, "The .svdag to write"),
              {".svdag"})
      ->required()
      ->type_name("OUT");
  add_pack_resources(app, config.get());
  add_examples(app, {"svdag unpack city.svdag.pack -o city.svdag"});
  app->preparse_callback([=](size_t) { *config = {}; });
  app->callback([=] { *command = *config; });
}

}  // namespace svdag
