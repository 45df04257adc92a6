// kSanitized is true in builds with a sanitizer, whose runtime makes more system calls than a
// decoder needs, and ends a process that runs out of memory.
#pragma once

namespace svdag {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

}  // namespace svdag
