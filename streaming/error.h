// The only error type of the project.
//
// Code at the edges (files, command line, limits) throws an Error. run_program() catches it, prints
// what() on stderr and exits with code(). what() is one sentence for the user: which file, what is
// wrong, at which byte, and what to do.
// Rejected: status codes (92 % of catastrophic failures are mishandled codes, Yuan et al. 2014).
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace svdag {

// Exit codes of all programs. To a farm, 4 and 5 are retryable, 2 and 3 permanent failures.
enum class ExitCode : int {
  kOk = 0,
  kDiffers = 1,    // the verifier found a difference
  kUsage = 2,      // the command line is wrong or requests something impossible
  kBadInput = 3,   // a scene or DAG file is missing, broken or unsupported
  kOutput = 4,     // disk full, I/O error, output not writable
  kMemory = 5,     // the memory budget does not suffice
  kInternal = 70,  // an assertion failed: a bug in the program (sysexits.h EX_SOFTWARE)
};

class Error : public std::runtime_error {
 public:
  // what() is "PATH: SENTENCE (at byte OFFSET)", without the parts that are not given and with '?'
  // in place of control characters. `sentence`: without a full stop.
  Error(ExitCode code, const std::string& sentence, const std::string& path = {},
        std::optional<uint64_t> offset = {});

  // Returns a copy with `hint` appended to what().
  Error with_hint(const std::string& hint) const;

  ExitCode code() const { return code_; }
  const std::string& path() const { return path_; }
  std::optional<uint64_t> offset() const { return offset_; }

 private:
  Error(const std::string& what, const Error& other)
      : std::runtime_error(what), code_(other.code_), path_(other.path_), offset_(other.offset_) {}

  ExitCode code_;
  std::string path_;
  std::optional<uint64_t> offset_;
};

// Throws Error (kBadInput).
[[noreturn]] void fail_input(const std::string& path, const std::string& sentence,
                             std::optional<uint64_t> offset = {});
// Throws Error (kUsage).
[[noreturn]] void fail_usage(const std::string& sentence);

constexpr const char* kNoMemory =
    "the machine is out of memory: lower --memory or free some memory";
// True for std::bad_alloc, and for a std::system_error that reports a lack of memory or threads.
bool is_lack_of_memory(const std::exception& error);

// Called by SVDAG_ASSERT: throws an Error (kInternal) that requests a bug report.
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

}  // namespace svdag

// Checked in release builds, too. Not for kernels, which are noexcept and tested from outside.
#define SVDAG_ASSERT(condition) \
  ((condition) ? (void)0 : ::svdag::assertion_failed(#condition, __FILE__, __LINE__))
