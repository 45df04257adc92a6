// Other programs: started, watched, ended.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace svdag {

// Starts `command` (a path or a name on PATH, and arguments) in a process group of its own, so that
// Ctrl-C reaches it only through us, with empty input; what it says is appended to the file `log`.
// Error (kOutput) if the log cannot be written, or the command not be started.
pid_t start_process(const std::vector<std::string>& command, const std::string& log);

// True once the process has ended; *code is then its exit code, or 128 + n if signal n ended it.
bool has_ended(pid_t process, int* code);

// Stops all of them (SIGTERM), and waits until they have exited.
void stop_processes(const std::vector<pid_t>& processes);

struct Answer {
  int code = 0;
  std::string output;  // stdout and stderr
};

// Runs `command` to its end. Error (kOutput) if it cannot be started.
Answer ask_process(const std::vector<std::string>& command);

// This program's own file, or the one that took its name since (an upgrade).
std::string own_program();

// What starts this very program: its file, or, where another took its name, the image that runs.
std::string own_image();

// `path` as an absolute path. Links are resolved on the host, so they are kept, and so is "..".
std::string from_anywhere(const std::string& path);

// What hosts start for `program`: a name without a folder is looked up on their PATH; empty: this
// program.
std::string program_on_hosts(const std::string& program);

}  // namespace svdag
