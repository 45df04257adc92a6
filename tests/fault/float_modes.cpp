// A library for LD_PRELOAD that changes the floating-point modes, as other libraries may do:
// flushes denormals to zero (like gcc's -ffast-math) and rounds up.
#include <cfenv>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace {

[[maybe_unused]] constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;

[[gnu::constructor]] void spoil() {
  std::fesetround(FE_UPWARD);
#if defined(__x86_64__)
  _mm_setcsr(_mm_getcsr() | kFlushToZero | kDenormalsAreZero);
#endif
}

}  // namespace
