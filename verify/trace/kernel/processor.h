// Runs a loop compiled for the instruction sets that this processor has.
//
// Traversal is mostly shifts and popcounts. Compiled for baseline x86-64 (2003) every popcount is a
// call and every variable shift needs register cl; compiled for AVX2 and BMI (2013) it is 1.5 times
// as fast. The attributes create a second copy of the loop and of everything it calls. Contraction
// is off (-ffp-contract=off), so both copies compute the same bits. Rejected: a ray per vector lane
// (half of its time are gathers of nodes; faster for some kinds of rays only).
#pragma once

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace svdag {

#if defined(__x86_64__)
#define SVDAG_FAST_TARGET "avx2,fma,bmi,bmi2,lzcnt,popcnt"

// Not every compiler's __builtin_cpu_supports accepts "lzcnt". Processors without it execute the
// instruction as bsr, which counts from the other end.
inline bool has_lzcnt() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  return __get_cpuid(0x80000001, &a, &b, &c, &d) != 0 && (c & bit_LZCNT) != 0;
}
#endif

inline bool has_fast_target() {
#if defined(__x86_64__)
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                          __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                          __builtin_cpu_supports("popcnt") && has_lzcnt();
  return has;
#else
  return false;
#endif
}

#if defined(__x86_64__)
template <typename Loop>
[[gnu::target(SVDAG_FAST_TARGET), gnu::flatten]] void run_with_avx2(const Loop& loop) {
  loop();
}
#endif

template <typename Loop>
void run_fast(const Loop& loop) {
#if defined(__x86_64__)
  if (has_fast_target()) return run_with_avx2(loop);
#endif
  loop();
}

}  // namespace svdag
