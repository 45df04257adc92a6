// Limits of counts, and a checked conversion to 32 bits: a count that does not fit is an Error,
// never a truncated number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "streaming/error.h"

namespace svdag {

// Largest number of threads that a command line or a plan may give.
constexpr size_t kMaxThreads = 1024;

// Returns `count`. Throws Error (kMemory) "more than 2^32 - 1 WHAT: ..." if it is larger than that.
inline uint32_t as_u32(uint64_t count, const char* what) {
  if (count > UINT32_MAX)
    throw Error(ExitCode::kMemory, std::string("more than 2^32 - 1 ") + what +
                                       ": lower the resolution or bake parts with --bounds");
  return uint32_t(count);
}

}  // namespace svdag
