#include "streaming/process/limited_child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <new>
#include <utility>
#include <vector>

#include "streaming/error.h"
#include "streaming/process/call_filter.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr uint64_t kMaxSentence = 1000;  // bytes

// Header of a message in the pipe; `bytes` bytes follow.
struct Frame {
  enum Kind : uint32_t { kBlock = 1, kError = 2, kEnd = 3 };
  uint32_t kind;
  uint32_t code;  // of an Error
  uint64_t bytes;
};

// --- In the child. A failure ends it, and the parent receives no kEnd.

void write_all(int pipe, const void* data, size_t size) {
  for (const char* at = static_cast<const char*>(data); size > 0;) {
    const ssize_t n = ::write(pipe, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(1);
    at += n;
    size -= size_t(n);
  }
}

void write_frame(int pipe, Frame::Kind kind, uint32_t code, std::span<const std::byte> bytes) {
  const Frame frame = {kind, code, bytes.size()};
  write_all(pipe, &frame, sizeof frame);
  write_all(pipe, bytes.data(), bytes.size());
}

void write_error(int pipe, ExitCode code, const char* sentence) {
  const size_t size = std::min<size_t>(std::strlen(sentence), kMaxSentence);
  write_frame(pipe, Frame::kError, uint32_t(code), std::as_bytes(std::span(sentence, size)));
}

void limit(int resource, uint64_t soft, uint64_t hard) {
  const rlimit value = {soft, hard};
  if (::setrlimit(__rlimit_resource(resource), &value) != 0) ::_exit(1);
}

// Size of the address space in use, in bytes.
uint64_t address_space() {
  unsigned long long pages = 0;
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr || std::fscanf(file, "%llu", &pages) != 1) ::_exit(1);
  std::fclose(file);
  return pages * uint64_t(::sysconf(_SC_PAGESIZE));
}

void apply_limits(int pipe, const ChildLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The parent's handlers protect its outputs and its mapped files.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGBUS, SIGSEGV})
    ::signal(signal, SIG_DFL);
  const uint64_t memory = address_space() + limits.memory;
  limit(RLIMIT_AS, memory, memory);
  limit(RLIMIT_CPU, limits.seconds, limits.seconds + 1);
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_FSIZE, 0, 0);
  if (pipe > 0) ::close_range(0, unsigned(pipe) - 1, 0);
  ::close_range(unsigned(pipe) + 1, ~0U, 0);
  limit(RLIMIT_NOFILE, 0, 0);
  if (limits.filter && !install_call_filter()) {
    write_error(pipe, ExitCode::kUsage, "--sandbox: this system has no seccomp filters");
    ::_exit(1);
  }
}

[[noreturn]] void run_child(int pipe, const ChildLimits& limits,
                            const std::function<void(const BlockSink&)>& work) {
  apply_limits(pipe, limits);
  try {
    work([pipe](std::span<const std::byte> bytes) {
      for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), kChildBlock)))
        write_frame(pipe, Frame::kBlock, 0, bytes.first(std::min(bytes.size(), kChildBlock)));
    });
    write_frame(pipe, Frame::kEnd, 0, {});
  } catch (const Error& error) {
    write_error(pipe, error.code(), error.what());
  } catch (const std::bad_alloc&) {
    write_error(pipe, ExitCode::kBadInput, "");  // the parent writes the message
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

// --- In the parent.

// The child process. The destructor kills it and waits for its end.
class Child {
 public:
  Child(const ChildLimits& limits, const std::function<void(const BlockSink&)>& work) {
    std::array<int, 2> ends;
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
      throw Error(ExitCode::kMemory, "--sandbox: cannot create a pipe");
    pipe_ = ends[0];
    pid_ = ::fork();
    if (pid_ == 0) run_child(ends[1], limits, work);
    ::close(ends[1]);
    if (pid_ < 0) {
      ::close(pipe_);
      throw Error(ExitCode::kMemory, "--sandbox: cannot start a process");
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    ::close(pipe_);
    if (pid_ > 0) end();
  }

  // Fills `out`. Returns false if the child closes the pipe earlier, or sends nothing for ten times
  // `seconds`.
  bool read(std::span<std::byte> out, uint64_t seconds) {
    while (!out.empty()) {
      check_interrupt();
      pollfd ready = {pipe_, POLLIN, 0};
      const uint64_t wait = std::min<uint64_t>(10 * seconds, 1'000'000) * 1000;
      const int n = ::poll(&ready, 1, int(wait));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      const ssize_t got = ::read(pipe_, out.data(), out.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      out = out.subspan(size_t(got));
    }
    return true;
  }

  // Ends the child and returns the reason for its end.
  std::string end_reason(const ChildLimits& limits) {
    ::close(std::exchange(pipe_, -1));
    for (int i = 0; i < 100 && !has_ended(); ++i) {  // its pipe closes slightly before it ends
      const timespec moment = {0, 10'000'000};
      ::nanosleep(&moment, nullptr);
    }
    const int status = end();
    if (!WIFSIGNALED(status)) return "it ended without a result";
    switch (WTERMSIG(status)) {
      case SIGSYS:
        return "it made a forbidden system call";
      case SIGXCPU:
        return "it took more than " + std::to_string(limits.seconds) + " s of processor time";
      case SIGKILL:
        return "it did not respond, or was killed";
      default:
        return "it crashed";
    }
  }

 private:
  bool has_ended() const {
    siginfo_t info = {};
    return ::waitid(P_PID, id_t(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0;
  }

  // Returns the wait status. If the child has already ended, the signal does not change that.
  int end() {
    ::kill(pid_, SIGKILL);
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return status;
  }

  pid_t pid_ = -1;
  int pipe_ = -1;
};

}  // namespace

void run_limited(const ChildLimits& limits, const std::string& path,
                 const std::function<void(const BlockSink& out)>& work, const BlockSink& use) {
  const auto stopped = [&](const std::string& reason) {
    check_interrupt();  // Ctrl-C on a terminal also ends the child
    fail_input(path, "the decoder was stopped: " + reason);
  };
  Child child(limits, work);
  std::vector<std::byte> bytes;
  for (;;) {
    Frame frame = {};
    if (!child.read(std::as_writable_bytes(std::span(&frame, 1)), limits.seconds))
      stopped(child.end_reason(limits));
    if (frame.kind == Frame::kEnd && frame.bytes == 0) return;
    const bool valid = (frame.kind == Frame::kBlock && frame.bytes <= kChildBlock) ||
                       (frame.kind == Frame::kError && frame.bytes <= kMaxSentence);
    if (!valid) stopped("it sent an invalid result");
    bytes.resize(size_t(frame.bytes));
    if (!child.read(bytes, limits.seconds)) stopped(child.end_reason(limits));
    if (frame.kind == Frame::kBlock) {
      use(bytes);
      continue;
    }
    if (bytes.empty()) stopped("it needs more memory than it may have");
    const ExitCode code = ExitCode(frame.code);
    const bool allowed = code == ExitCode::kMemory || code == ExitCode::kUsage;
    const std::string sentence(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    throw Error(allowed ? code : ExitCode::kBadInput, sentence);
  }
}

}  // namespace svdag
