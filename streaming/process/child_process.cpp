#include "streaming/process/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "streaming/error.h"
#include "streaming/file/system_call.h"

extern char** environ;

namespace svdag {
namespace {

constexpr const char* kOwnImage = "/proc/self/exe";
constexpr const char* kDeleted = " (deleted)";  // the kernel appends this to a deleted file's name

class FileActions {
 public:
  FileActions() { posix_spawn_file_actions_init(&actions_); }
  FileActions(const FileActions&) = delete;
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }

  void open(int fd, const char* path, int flags) {
    posix_spawn_file_actions_addopen(&actions_, fd, path, flags, 0666);
  }
  void duplicate(int from, int to) { posix_spawn_file_actions_adddup2(&actions_, from, to); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

// Opened here, not by the child, so that an Error names the log instead of the program.
class LogFile {
 public:
  explicit LogFile(const std::string& path)
      : fd_(retry_interrupted([&] {
          return ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
        })) {
    if (fd_ < 0) fail_call(ExitCode::kOutput, "cannot be opened", path, errno);
  }
  LogFile(const LogFile&) = delete;
  ~LogFile() { ::close(fd_); }
  int descriptor() const { return fd_; }

 private:
  int fd_;
};

pid_t spawn(const std::vector<std::string>& command, const FileActions& actions) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t process = 0;
  const int error =
      posix_spawnp(&process, words[0], actions.get(), &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) fail_call(ExitCode::kOutput, "cannot be started", command[0], error);
  return process;
}

int code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int wait_for(pid_t process) {
  for (;;) {
    int status = 0;
    if (::waitpid(process, &status, 0) == process) return code_of(status);
    if (errno != EINTR) return int(ExitCode::kInternal);  // its exit status is unknown
  }
}

}  // namespace

pid_t start_process(const std::vector<std::string>& command, const std::string& log) {
  const LogFile file(log);
  FileActions actions;
  actions.duplicate(file.descriptor(), STDOUT_FILENO);
  actions.duplicate(STDOUT_FILENO, STDERR_FILENO);
  actions.open(STDIN_FILENO, "/dev/null", O_RDONLY);
  return spawn(command, actions);
}

bool has_ended(pid_t process, int* code) {
  int status = 0;
  const pid_t ended = ::waitpid(process, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return false;
  *code = ended == process ? code_of(status) : int(ExitCode::kInternal);  // status unknown
  return true;
}

void stop_processes(const std::vector<pid_t>& processes) {
  for (const pid_t process : processes) ::kill(-process, SIGTERM);
  for (const pid_t process : processes) wait_for(process);
}

ProcessResult run_process(const std::vector<std::string>& command) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw Error(ExitCode::kOutput, "cannot be started: the pipe for its output cannot be created",
                command[0]);
  FileActions actions;
  actions.open(STDIN_FILENO, "/dev/null", O_RDONLY);
  actions.duplicate(ends[1], STDOUT_FILENO);
  actions.duplicate(ends[1], STDERR_FILENO);
  pid_t process = 0;
  try {
    process = spawn(command, actions);
  } catch (...) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw;
  }
  ::close(ends[1]);
  ProcessResult result;
  char buffer[4096];
  for (;;) {
    const ssize_t n = ::read(ends[0], buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    result.output.append(buffer, size_t(n));
  }
  ::close(ends[0]);
  result.code = wait_for(process);
  return result;
}

std::string own_program() {
  std::error_code error;
  std::string path = std::filesystem::read_symlink(kOwnImage, error).string();
  if (path.ends_with(kDeleted)) path.resize(path.size() - std::strlen(kDeleted));
  return error ? "svdag" : path;
}

std::string own_image() {
  std::error_code error;
  const std::string path = std::filesystem::read_symlink(kOwnImage, error).string();
  return error || path.ends_with(kDeleted) ? kOwnImage : path;
}

}  // namespace svdag
