// Counts that become 32-bit numbers: what does not fit is an Error, never another number.
#pragma once

#include <cstdint>
#include <string>

#include "streaming/error.h"

namespace svdag {

// `count`, or Error (kMemory) "more than 2^32 - 1 WHAT: ...".
inline uint32_t as_u32(uint64_t count, const char* what) {
  if (count > UINT32_MAX)
    throw Error(ExitCode::kMemory, std::string("more than 2^32 - 1 ") + what +
                                       ": lower the resolution or bake parts with --bounds");
  return uint32_t(count);
}

}  // namespace svdag
