// Runs a loop with the instructions that this processor has.
//
// The traversal is bits and counts: compiled for x86-64 as of 2003 every popcount is a call and
// every shift needs one certain register. Compiled for AVX2 and BMI (2013) it is 1.5 times as fast.
// The attributes make a second copy of the loop and of all it calls; nothing else changes, and
// contraction is off (-ffp-contract=off), so the copies compute the same bits. Rejected: lanes as
// rays (docs/performance.md, "Tracing").
#pragma once

namespace svdag {

#if defined(__x86_64__)
#define SVDAG_FAST_TARGET "avx2,fma,bmi,bmi2,lzcnt,popcnt"
#endif

inline bool has_fast_target() {
#if defined(__x86_64__)
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                          __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
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
