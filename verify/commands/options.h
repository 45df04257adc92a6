// The command lines of `svdag-verify`, in a few *_options.cpp.
//
// Only those files, main.cpp and verify/trace/view_options.cpp include CLI11 (6 s each to compile).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/scene/scene.h"
#include "verify/commands/commands.h"

namespace CLI {
class App;
}

namespace svdag {

// Each adds a command to the program, and sets *parsed to its struct when the command is parsed.
void add_check(CLI::App* app, VerifyCommand* parsed);
void add_mesh(CLI::App* app, VerifyCommand* parsed);
void add_colours(CLI::App* app, VerifyCommand* parsed);
void add_diff(CLI::App* app, VerifyCommand* parsed);
void add_vdb(CLI::App* app, VerifyCommand* parsed);
void add_trace(CLI::App* app, VerifyCommand* parsed);
void add_render(CLI::App* app, VerifyCommand* parsed);
void add_report(CLI::App* app, VerifyCommand* parsed);
void add_view(CLI::App* app, VerifyCommand* parsed);

// Options of several commands (shared_options.cpp).
void add_common(CLI::App* command, CommonConfig* config, bool with_json);
void add_threads(CLI::App* command, CommonConfig* config);
void add_scene(CLI::App* command, SceneConfig* scene);
void add_memory(CLI::App* command, uint64_t* memory);
// A number with an optional suffix: "10M".
void add_count(CLI::App* command, const std::string& option, uint64_t* count, const char* text,
               const char* type = "N");
void add_count(CLI::App* command, const std::string& option, std::optional<uint64_t>* count,
               const char* text, const char* type = "N");
// FILE, the .svdag file, the first argument of most commands.
void add_file(CLI::App* command, std::string* file);

}  // namespace svdag
