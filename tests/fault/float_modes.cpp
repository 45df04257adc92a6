// What a library of another project may do to a program that loads it, for LD_PRELOAD: numbers
// next to zero are taken for zero (gcc's -ffast-math does that), and sums are rounded up.
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
