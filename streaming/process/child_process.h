// Child processes: start, poll, run to completion, terminate; the path of this program.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace svdag {

// Starts `command` (a path or a name on PATH, then arguments) with empty stdin; stdout and stderr
// are appended to the file `log`. The process gets its own process group, so that Ctrl-C reaches
// only this process. Throws Error (kOutput) if the log cannot be opened or the command not started.
pid_t start_process(const std::vector<std::string>& command, const std::string& log);

// Returns true if the process has ended; *code is then its exit code, or 128 + n if killed by
// signal n.
bool has_ended(pid_t process, int* code);

// Sends SIGTERM to all processes and waits until they have exited.
void stop_processes(const std::vector<pid_t>& processes);

struct ProcessResult {
  int code = 0;
  std::string output;  // stdout and stderr
};

// Runs `command` and waits for it. Throws Error (kOutput) if it cannot be started.
ProcessResult run_process(const std::vector<std::string>& command);

// Path of this program's file, even if another file has replaced it (an upgrade).
std::string own_program();

// A path that starts exactly this program: its file, or /proc/self/exe if the file was replaced.
std::string own_image();

}  // namespace svdag
