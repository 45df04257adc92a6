#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "io/dag/open_dag.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/printable.h"
#include "streaming/process/interrupt.h"
#include "verify/commands/commands.h"
#include "verify/view/folder.h"
#include "verify/view/redirect_page.h"
#include "verify/view/server.h"

namespace svdag {
namespace {

// Parses "8123" or "8123/TOKEN", or the URL that an earlier run has printed.
void parse_address(std::string text, ServerConfig* server) {
  const std::string shown = text;
  for (const char* const prefix : {"http://", "127.0.0.1:", "localhost:"}) {
    if (text.starts_with(prefix)) text.erase(0, std::string(prefix).size());
  }
  const auto read = std::from_chars(text.data(), text.data() + text.size(), server->port);
  std::string token = text.substr(size_t(read.ptr - text.data()));
  if (token.ends_with('/')) token.pop_back();
  if (token.starts_with('/')) token.erase(0, 1);
  const bool is_token = token.find_first_not_of(
                            "0123456789abcdefghijklmnopqrstuvwxyz"
                            "ABCDEFGHIJKLMNOPQRSTUVWXYZ-_") == token.npos;
  if (read.ec != std::errc() || server->port < 1 || server->port > 65535 || !is_token ||
      (!token.empty() && token.size() < 16))
    fail_usage("--at: \"" + shown +
               "\" is not PORT or PORT/TOKEN with 16 or more letters and digits");
  server->token = token;
}

bool has_desktop() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

// Opens a page in the user's browser.
void open_browser(const std::string& page) {
  if (const pid_t child = fork(); child == 0) {
    if (fork() == 0) {  // not our child, so that no zombie remains
      setsid();         // Ctrl-C in the terminal does not end the browser
      signal(SIGPIPE, SIG_DFL);
      std::freopen("/dev/null", "w", stdout);
      std::freopen("/dev/null", "w", stderr);
      execlp("xdg-open", "xdg-open", page.c_str(), nullptr);
    }
    _exit(0);
  } else if (child > 0) {
    waitpid(child, nullptr, 0);
  }
}

int write_to(const std::string& folder, const ViewConfig& config, const DagFile& file,
             const TileCutter& cutter, const DagColours* colours, int up) {
  ParallelExecutor executor(threads_or_all(config.common.threads));
  Progress progress(config.common.progress);
  const TileList list = list_tiles(cutter, colours != nullptr);
  const uint64_t estimate = estimate_bytes(cutter, list, colours, executor);
  if (!config.common.quiet) {
    std::printf("%s: %s, about %s\n", printable(folder).c_str(),
                format_count(list.cubes.size(), "tile").c_str(), format_bytes(estimate).c_str());
    std::fflush(stdout);
  }
  const uint64_t bytes = write_folder(folder, file, cutter, list, colours, up, executor, progress);
  progress.finish();
  if (!config.common.quiet)
    std::printf("%s: written, %s\n", printable(folder).c_str(), format_bytes(bytes).c_str());
  return int(ExitCode::kOk);
}

int view(const ViewConfig& config) {
  ServerConfig server;
  if (!config.at.empty()) parse_address(config.at, &server);
  const DagFile file = open_dag(config.file, config.selection);
  if (file.view().empty()) fail_usage(file.path() + ": has no voxel to show");
  const uint32_t levels = file.view().levels;
  const uint64_t level = config.level.value_or(levels);
  if (level < 3 || level > levels)
    fail_usage("--level: " + file.path() + " has levels 3 to " + std::to_string(levels) +
               " to show");
  const TileCutter cutter(file, uint32_t(level));
  MemoryBudget budget(memory_or_default(0));
  std::optional<DagColours> colours;
  if (file.has_colours()) colours.emplace(file, &budget);
  const DagColours* const shown = colours ? &*colours : nullptr;
  if (config.to) return write_to(*config.to, config, file, cutter, shown, config.up);
  server.up = config.up;
  server.keep = config.keep;
  std::optional<RedirectPage> page;  // until the end: a browser may take long to start
  serve(file, cutter, shown, server, [&](const std::string& url) {
    std::printf("%s\n", url.c_str());
    std::fflush(stdout);
    if (config.open && has_desktop()) open_browser(page.emplace(url).path());
  });
  return int(ExitCode::kOk);
}

}  // namespace

int run(const ViewConfig& config) {
  const Stopwatch stopwatch(config.common);
  catch_interrupts();
  try {
    return view(config);
  } catch (Interrupted& interrupted) {
    interrupted.resumable = true;
    interrupted.resume_message =
        config.to ? "stopped; the same command continues" : "stopped serving";
    throw;
  }
}

}  // namespace svdag
