// The vectorized cells64.h: vectors of 256 bits, for processors with AVX2 and FMA.
//
// The target attribute is on each function, so the rest of a file that includes this one is
// compiled for the baseline processor. Callers check has_fast_target() (processor.h) first.
#pragma once

#if defined(__x86_64__)

#include <immintrin.h>

#include <cstdint>

#include "verify/trace/kernel/cells64.h"
#include "verify/trace/kernel/processor.h"

#define SVDAG_AVX2 [[gnu::target(SVDAG_FAST_TARGET), gnu::always_inline]] inline

namespace svdag {

// Byte shuffles and coordinates per cell, bit permutations per mirroring.
struct Cells64Tables {
  alignas(64) uint8_t low[3][64];      // [axis][cell]: index of the byte of the near plane
  alignas(64) uint8_t high[3][64];     // the same for the far plane
  alignas(32) double position[64][4];  // a cell's coordinates in its node
  struct {
    alignas(16) uint8_t bytes[16];       // permutes the bytes of a mask
    alignas(16) uint8_t nibbles[2][16];  // lower, upper half of a byte -> mirrored bits
  } mirror[8];

  constexpr Cells64Tables() : low{}, high{}, position{}, mirror{} {
    for (unsigned cell = 0; cell < 64; ++cell) {
      for (unsigned a = 0; a < 3; ++a) {
        const unsigned at = (cell >> (5 - a) & 1U) << 1 | (cell >> (2 - a) & 1U);
        low[a][cell] = uint8_t(4 * a + at);
        position[cell][a] = at;
        high[a][cell] = uint8_t(at < 3 ? 4 * a + at + 1 : 12 + a);
      }
    }
    for (unsigned flip = 0; flip < 8; ++flip) {
      for (unsigned i = 0; i < 16; ++i) {
        mirror[flip].bytes[i] = uint8_t(i < 8 ? i ^ flip : 0x80);
        for (unsigned bit = 0; bit < 4; ++bit) {
          if (!(i >> bit & 1U)) continue;
          mirror[flip].nibbles[0][i] |= uint8_t(1U << (bit ^ flip));
          mirror[flip].nibbles[1][i] |= uint8_t(1U << ((bit + 4) ^ flip));
        }
      }
    }
  }
};
inline constexpr Cells64Tables kCells64;

struct Avx2Cells {
  SVDAG_AVX2 static uint64_t of(const Tree64View& tree, const RayTimes& ray, const Visit& visit) {
    const __m256d side = _mm256_broadcast_sd(&tree.side[visit.depth]);
    const __m256d wide = _mm256_mul_pd(side, _mm256_set1_pd(4));
    const __m256d corner =
        _mm256_add_pd(_mm256_load_pd(visit.parent),
                      _mm256_mul_pd(_mm256_load_pd(kCells64.position[visit.cell]), wide));
    _mm256_store_pd(visit.corner, corner);
    return mirrored(ray, *visit.node) &
           met(ray, corner, side, wide, ray.scale * tree.per_side[visit.depth]);
  }

  // The four lanes of a vector are planes 0 .. 3 of one axis, or plane 4 of each axis and the end.
  SVDAG_AVX2 static uint64_t met(const RayTimes& ray, __m256d corner, __m256d side, __m256d wide,
                                 double scale_of_side) {
    const __m256d origin = _mm256_load_pd(ray.origin), inverse = _mm256_load_pd(ray.inverse);
    const __m256d enter = entered(ray, _mm256_mul_pd(_mm256_sub_pd(corner, origin), inverse));
    const __m256d beyond = _mm256_sub_pd(_mm256_add_pd(corner, wide), origin);
    const __m256d last =
        _mm256_blend_pd(_mm256_mul_pd(beyond, inverse), _mm256_set1_pd(ray.end), 8);
    const __m256d steps = _mm256_mul_pd(side, _mm256_setr_pd(0, 1, 2, 3));
    const __m256d scale = _mm256_set1_pd(scale_of_side);
    const __m128i xy = _mm_packus_epi32(units(times<0>(ray, corner, steps), enter, scale),
                                        units(times<1>(ray, corner, steps), enter, scale));
    const __m128i ze = _mm_packus_epi32(units(times<2>(ray, corner, steps), enter, scale),
                                        units(last, enter, scale));
    const __m128i bytes = _mm_packus_epi16(xy, ze);
    const __m128i end = _mm_shuffle_epi8(bytes, _mm_set1_epi8(15));
    const __m256i low = _mm256_broadcastsi128_si256(_mm_max_epu8(bytes, _mm_set1_epi8(1)));
    const __m256i high = _mm256_broadcastsi128_si256(_mm_min_epu8(bytes, end));
    return uint64_t(half<0>(low, high)) | uint64_t(half<32>(low, high)) << 32;
  }

  SVDAG_AVX2 static uint64_t mirrored(const RayTimes& ray, uint64_t cells) {
    const auto& mirror = kCells64.mirror[ray.flip & 7U];
    const __m128i four = _mm_set1_epi8(15);
    const __m128i bytes = _mm_shuffle_epi8(_mm_cvtsi64_si128(int64_t(cells)), load(mirror.bytes));
    const __m128i upper = _mm_and_si128(_mm_srli_epi16(bytes, 4), four);
    return uint64_t(_mm_cvtsi128_si64(
        _mm_or_si128(_mm_shuffle_epi8(load(mirror.nibbles[0]), _mm_and_si128(bytes, four)),
                     _mm_shuffle_epi8(load(mirror.nibbles[1]), upper))));
  }

 private:
  SVDAG_AVX2 static __m128i load(const uint8_t* from) {
    return _mm_load_si128(reinterpret_cast<const __m128i*>(from));
  }

  // The latest of the three near planes' times and the begin, in all lanes.
  SVDAG_AVX2 static __m256d entered(const RayTimes& ray, __m256d near) {
    __m256d latest = _mm256_blend_pd(near, _mm256_set1_pd(ray.begin), 8);
    latest = _mm256_max_pd(latest, _mm256_permute2f128_pd(latest, latest, 1));
    return _mm256_max_pd(latest, _mm256_permute_pd(latest, 5));
  }

  template <int kAxis>
  SVDAG_AVX2 static __m256d times(const RayTimes& ray, __m256d corner, __m256d steps) {
    const __m256d planes = _mm256_add_pd(_mm256_permute4x64_pd(corner, kAxis * 0x55), steps);
    return _mm256_mul_pd(_mm256_sub_pd(planes, _mm256_broadcast_sd(ray.origin + kAxis)),
                         _mm256_broadcast_sd(ray.inverse + kAxis));
  }

  // Times long before `enter` become negative; packing saturates them to byte 0.
  SVDAG_AVX2 static __m128i units(__m256d times, __m256d enter, __m256d scale) {
    const __m256d since = _mm256_sub_pd(times, enter);
    const __m256d raised = _mm256_fmadd_pd(since, scale, _mm256_set1_pd(1));
    return _mm256_cvttpd_epi32(_mm256_min_pd(raised, _mm256_set1_pd(254)));
  }

  template <int kFirst>
  SVDAG_AVX2 static uint32_t half(__m256i low, __m256i high) {
    const __m256i near = _mm256_max_epu8(_mm256_max_epu8(chosen(low, kCells64.low[0] + kFirst),
                                                         chosen(low, kCells64.low[1] + kFirst)),
                                         chosen(low, kCells64.low[2] + kFirst));
    const __m256i far = _mm256_min_epu8(_mm256_min_epu8(chosen(high, kCells64.high[0] + kFirst),
                                                        chosen(high, kCells64.high[1] + kFirst)),
                                        chosen(high, kCells64.high[2] + kFirst));
    return uint32_t(_mm256_movemask_epi8(_mm256_cmpeq_epi8(_mm256_max_epu8(near, far), far)));
  }
  SVDAG_AVX2 static __m256i chosen(__m256i bytes, const uint8_t* by_cell) {
    return _mm256_shuffle_epi8(bytes, _mm256_load_si256(reinterpret_cast<const __m256i*>(by_cell)));
  }
};

}  // namespace svdag

#endif
