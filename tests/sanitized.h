// Whether this is a build with a sanitizer, whose runtime needs more system calls than a decoder
// does, and ends a process that gets no memory.
#pragma once

namespace svdag {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

}  // namespace svdag
