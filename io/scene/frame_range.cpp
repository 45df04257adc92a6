#include "io/scene/frame_range.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "io/dag/format.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr size_t kMaxDigits = 9;  // before the point, and after it: all numbers are below 10^18

// Digits before and after the point.
struct Decimal {
  std::string whole, part;

  uint64_t scaled(size_t decimals) const {
    const std::string digits = whole + part + std::string(decimals - part.size(), '0');
    uint64_t value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
  }
};

bool read_decimal(std::string_view text, Decimal* out) {
  const size_t point = std::min(text.find('.'), text.size());
  out->whole = text.substr(0, point);
  out->part = text.substr(std::min(point + 1, text.size()));
  const auto are_digits = [](const std::string& digits) {
    return digits.size() <= kMaxDigits &&
           std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
  };
  return !out->whole.empty() && (point == text.size() || !out->part.empty()) &&
         are_digits(out->whole) && are_digits(out->part);
}

// With at least `digits` digits.
std::string decimal_text(uint64_t value, int decimals, size_t digits) {
  std::string text = std::to_string(value);
  digits = std::max(digits, size_t(decimals) + 1);
  if (text.size() < digits) text.insert(0, digits - text.size(), '0');
  if (decimals > 0) text.insert(text.size() - size_t(decimals), 1, '.');
  return text;
}

}  // namespace

std::string FrameRange::name(uint32_t i) const {
  return decimal_text(first + i * step, decimals,
                      std::to_string(first + (count - 1) * step).size());
}

std::string FrameRange::text() const {
  return name(0) + " to " + name(count - 1) + " by " + decimal_text(step, decimals, 0);
}

FrameRange parse_frames(const std::string& text) {
  const auto fail = [&](const std::string& why) {
    fail_usage("--frames: \"" + text + "\" " + why);
  };
  std::array<Decimal, 3> given;
  std::string_view rest = text;
  size_t decimals = 0;
  for (Decimal& number : given) {
    const bool is_last = &number == &given.back();
    const size_t end = is_last ? rest.size() : rest.find(':');
    if (end == rest.npos || !read_decimal(rest.substr(0, end), &number))
      fail(
          "is not A:B:STEP in seconds, for example 0:2.5:0.1, of at most 9 digits before and "
          "after the point");
    rest.remove_prefix(is_last ? end : end + 1);
    decimals = std::max(decimals, number.part.size());
  }
  const uint64_t first = given[0].scaled(decimals), last = given[1].scaled(decimals),
                 step = given[2].scaled(decimals);
  if (first > last) fail("ends before it begins");
  if (step == 0) fail("has a step of 0");
  const uint64_t steps = (last - first) / step;
  if (steps >= kMaxLayers)
    fail("has " + format_count(steps + 1) + " frames: a file has at most " +
         format_count(kMaxLayers) + " layers");
  return {first, step, uint32_t(steps + 1), int(decimals)};
}

double parse_time(const std::string& text) {
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(seconds))
    fail_usage("--time: \"" + text + "\" is not a number of seconds");
  return seconds;
}

}  // namespace svdag
