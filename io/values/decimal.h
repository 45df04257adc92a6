// Parses decimal numbers to the same bits as std::from_chars, common ones faster.
//
// Up to eight digits are taken at once from a 64-bit word (Lemire 2018). A number m / 10^k with
// m <= 2^53 and k <= 22 is the quotient of two doubles that are exact, so that one division rounds
// it correctly (Clinger 1990). Longer words, exponents and words that are not numbers go to
// from_chars. Rejected: the same through a float quotient (few floats are that short).
// Rejected as well: the library fast_float (slower for words of up to six digits, and 40 lines
// saved).
#pragma once

#include <array>
#include <bit>
#include <cfloat>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace svdag {

static_assert(std::endian::native == std::endian::little);
static_assert(FLT_EVAL_METHOD == 0);  // one division is one rounding

// The number of digits at the start of eight characters, and their value.
struct Digits {
  int count;
  uint64_t value;
};
inline Digits leading_digits(const char* eight) {
  uint64_t word;
  std::memcpy(&word, eight, sizeof word);
  word ^= 0x3030303030303030;  // digits become 0 .. 9
  // The lowest flag is right; a carry out of a byte that is not a digit affects only those above.
  const uint64_t no_digit = ((word + 0x7676767676767676) | word) & 0x8080808080808080;
  const int count = no_digit == 0 ? 8 : std::countr_zero(no_digit) / 8;
  if (count == 0) return {0, 0};
  word <<= 8 * (8 - count);  // zeros before the first digit
  word = 10 * word + (word >> 8);
  word = ((word & 0x000000FF000000FF) * 0x000F424000000064 +
          ((word >> 16) & 0x000000FF000000FF) * 0x0000271000000001) >>
         32;
  return {count, word};
}

inline constexpr std::array<uint64_t, 8> kPowers = {1,     10,     100,     1000,
                                                    10000, 100000, 1000000, 10000000};
inline constexpr std::array<double, 16> kExactPowers = {
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

// As std::from_chars(first, last, value).
template <class T>
std::from_chars_result parse_decimal(const char* first, const char* last, T& value) {
  return std::from_chars(first, last, value);
}
template <>
inline std::from_chars_result parse_decimal(const char* first, const char* last, double& value) {
  constexpr std::ptrdiff_t kReach = 32;  // more than the code below reads
  constexpr int kMaxDigits = 19;         // of a uint64 without overflow
  if (last - first < kReach) return std::from_chars(first, last, value);
  const bool negative = *first == '-';
  const char* p = first + negative;
  const Digits whole = leading_digits(p);
  p += whole.count;
  uint64_t mantissa = whole.value;
  int fraction = 0;
  bool plain = whole.count > 0 && whole.count < 8;
  if (*p == '.') {
    const Digits digits = leading_digits(++p);
    p += digits.count;
    fraction = digits.count;
    if (digits.count == 8) {
      const Digits more = leading_digits(p);
      p += more.count;
      fraction += more.count;
      plain = plain && more.count < 8 && whole.count + fraction <= kMaxDigits;
      mantissa = (mantissa * 100000000 + digits.value) * kPowers[more.count & 7] + more.value;
    } else {
      mantissa = mantissa * kPowers[digits.count] + digits.value;
    }
  }
  if (!plain || mantissa > uint64_t(1) << 53 || (*p | 0x20) == 'e')
    return std::from_chars(first, last, value);
  const double magnitude = double(mantissa) / kExactPowers[fraction];
  // No branch: signs are unpredictable.
  value = std::bit_cast<double>(std::bit_cast<uint64_t>(magnitude) | uint64_t(negative) << 63);
  return {p, std::errc{}};
}

}  // namespace svdag
