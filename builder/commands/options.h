// The command lines of `svdag`: each add_*() adds a command to the program, with options that fill
// its struct (builder/commands/commands.h), and sets *command when that command is parsed.
//
// Only *_options.cpp and main.cpp include CLI11, which takes 6 s to compile.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "builder/commands/commands.h"

namespace CLI {
class App;
class Option;
class Option_group;
}  // namespace CLI

namespace svdag {

void add_build(CLI::App* program, Command* command);
void add_batch(CLI::App* program, Command* command);
void add_merge(CLI::App* program, Command* command);
void add_plan(CLI::App* program, Command* command);
void add_run(CLI::App* program, Command* command);
void add_submit(CLI::App* program, Command* command);
void add_info(CLI::App* program, Command* command);
void add_query(CLI::App* program, Command* command);
void add_edit(CLI::App* program, Command* command);
void add_colour(CLI::App* program, Command* command);
void add_convert(CLI::App* program, Command* command);
void add_pack(CLI::App* program, Command* command);
void add_unpack(CLI::App* program, Command* command);

// Parses one bake of a batch like a command line of `svdag build`; options that are not given keep
// their value in `defaults`. Errors: kUsage.
BakeCommand parse_bake(const std::vector<std::string>& arguments, const BakeCommand& defaults);

// Options of several commands (shared_options.cpp).
void add_quiet(CLI::App* app, OutputConfig* output);
void add_verbose(CLI::App* app, OutputConfig* output, const std::string& text);
void add_progress(CLI::App* app, OutputConfig* output);
// How a scene is read, besides its paths.
void add_scene_options(CLI::App* app, SceneConfig* scene);
// Adds the options of memory, threads and scratch, which do not affect the result. `own_scratch`:
// the default scratch folder, for the help text.
void add_resource_options(CLI::App* app, uint64_t* memory, size_t* threads, std::string* scratch,
                          const char* own_scratch = "OUT.scratch",
                          const char* threads_text = "Threads (default: all processors)");
// Adds --resume, --restart and --checkpoint.
void add_resume_options(CLI::App* app, Unfinished* unfinished, double* checkpoint);
// Adds --colour-level and --colour-error, and returns them. `pass`: where they are set.
std::array<CLI::Option*, 2> add_colour_options(CLI::App* app,
                                               const std::function<ColourPassConfig&()>& pass);
// Adds --colours, with these.
void add_colours(CLI::App* app, std::optional<ColourPassConfig>* colours);
// Adds --checkpoint.
CLI::Option* add_checkpoint(CLI::App* app, double* seconds);
// Adds --frames; before the grid and layer options.
void add_frames(CLI::App* app, BuildConfig* build);
// Adds --palette.
void add_palette(CLI::App* app, LayerPalette* palette);

// Adds --layers and --no-union.
void add_layer_options(CLI::App* app, BuildConfig* build);
// Adds the grid options of a bake; exactly one option of the returned group is required.
CLI::Option_group* add_grid_options(CLI::App* app, BuildConfig* build);

}  // namespace svdag
