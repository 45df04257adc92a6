// The one error type of the project.
//
// An Error is thrown at the edges (files, command line, limits) and caught once, in main(), which
// prints what() on stderr and exits with code(). what() is one sentence for the person at the
// keyboard: what went wrong, in which file, where, and what to do about it.
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
  kInternal = 70,  // an assertion failed: a defect of ours (sysexits.h EX_SOFTWARE)
};

class Error : public std::runtime_error {
 public:
  // what(): `path`, `sentence` (without a full stop), byte `offset`; '?' for control characters.
  Error(ExitCode code, const std::string& sentence, const std::string& path = {},
        std::optional<uint64_t> offset = {});

  // A copy whose sentence ends with `hint`.
  Error with_hint(const std::string& hint) const;

  ExitCode code() const { return code_; }
  const std::string& path() const { return path_; }
  std::optional<uint64_t> offset() const { return offset_; }

 private:
  Error(const std::string& what, const Error& like)
      : std::runtime_error(what), code_(like.code_), path_(like.path_), offset_(like.offset_) {}

  ExitCode code_;
  std::string path_;
  std::optional<uint64_t> offset_;
};

// Shorthands for the two most common edges.
[[noreturn]] void fail_input(const std::string& path, const std::string& sentence,
                             std::optional<uint64_t> offset = {});
[[noreturn]] void fail_usage(const std::string& sentence);

constexpr const char* kNoMemory =
    "the machine has no memory left: give less with --memory or free some";
// True if `error` says that the system has no memory, or no thread, to give.
bool is_lack_of_memory(const std::exception& error);

// Called by SVDAG_ASSERT: throws an Error (kInternal) that requests a bug report.
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

}  // namespace svdag

// Stays on in release builds. Not for kernels, which are noexcept and tested from outside.
#define SVDAG_ASSERT(condition) \
  ((condition) ? (void)0 : ::svdag::assertion_failed(#condition, __FILE__, __LINE__))
