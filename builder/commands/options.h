// The options of the commands of `svdag`: each command beside its kind, in one *_options.cpp.
//
// Only those files and main.cpp see the library that reads command lines (6 s each to compile).
#pragma once

#include "builder/commands/commands.h"

namespace CLI {
class App;
class Option_group;
}  // namespace CLI

namespace svdag {

// Each adds a command to the program, with options that fill its Config.
CLI::App* add_build(CLI::App* program, BuildCommandConfig* config);
CLI::App* add_merge(CLI::App* program, MergeCommandConfig* config);
CLI::App* add_plan(CLI::App* program, PlanCommandConfig* config);
CLI::App* add_run(CLI::App* program, RunCommandConfig* config);
CLI::App* add_submit(CLI::App* program, SubmitCommandConfig* config);
CLI::App* add_info(CLI::App* program, InfoCommandConfig* config);

// What several commands understand (shared_options.cpp).
void add_quiet(CLI::App* app, OutputConfig* output);
void add_verbose(CLI::App* app, OutputConfig* output, const std::string& text);
void add_progress(CLI::App* app, OutputConfig* output);
void add_scene_options(CLI::App* app, NameFilter* names, bool* skip_invalid, bool* sandbox);
// Memory, threads and disk; the result is the same with any of them.
// `own_scratch`: where it is by default, in words.
void add_resource_options(CLI::App* app, uint64_t* memory, size_t* threads, std::string* scratch,
                          const char* own_scratch = "OUT.scratch",
                          const char* threads_text = "Threads (default: all processors)");
// The grid of a bake; one of the options in the group returned is required.
CLI::Option_group* add_grid_options(CLI::App* app, BuildConfig* build);

}  // namespace svdag
