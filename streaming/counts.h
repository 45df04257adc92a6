// Limits of counts. One that becomes a 32-bit number and does not fit is an Error, never another
// number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "streaming/error.h"

namespace svdag {

// More threads than this are taken for a slip of the pen.
constexpr size_t kMostThreads = 1024;

// `count`, or Error (kMemory) "more than 2^32 - 1 WHAT: ...".
inline uint32_t as_u32(uint64_t count, const char* what) {
  if (count > UINT32_MAX)
    throw Error(ExitCode::kMemory, std::string("more than 2^32 - 1 ") + what +
                                       ": lower the resolution or bake parts with --bounds");
  return uint32_t(count);
}

}  // namespace svdag
