// The options of the commands of `svdag-verify`, in a few *_options.cpp.
//
// Only those files and main.cpp see the library that reads command lines (6 s each to compile).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/scene/scene.h"
#include "verify/commands/common.h"

namespace CLI {
class App;
}

namespace svdag {

// Each adds a command to the program, which runs when the command line was read and leaves its
// exit code in *result.
void add_check(CLI::App* app, int* result);
void add_mesh(CLI::App* app, int* result);
void add_diff(CLI::App* app, int* result);
void add_vdb(CLI::App* app, int* result);
void add_trace(CLI::App* app, int* result);
void add_render(CLI::App* app, int* result);
void add_report(CLI::App* app, int* result);

// What several commands understand (shared_options.cpp).
void add_common(CLI::App* command, CommonConfig* config, bool with_json);
void add_threads(CLI::App* command, CommonConfig* config);
void add_scene(CLI::App* command, SceneConfig* scene);
void add_memory(CLI::App* command, uint64_t* memory);
// A number as people write it: "10M".
void add_count(CLI::App* command, const std::string& option, uint64_t* count, const char* text,
               const char* type = "N");
void add_count(CLI::App* command, const std::string& option, std::optional<uint64_t>* count,
               const char* text, const char* type = "N");
// "The .svdag file", the first argument of most.
void add_file(CLI::App* command, std::string* file);

}  // namespace svdag
