#include "io/units.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "streaming/error.h"

namespace svdag {
namespace {

struct Length {
  const char* name;
  double metres;
};
constexpr Length kLengths[] = {{"mm", 0.001}, {"cm", 0.01},   {"m", 1},
                               {"km", 1000},  {"in", 0.0254}, {"ft", 0.3048}};

}  // namespace

uint64_t parse_count(std::string_view text, const char* option) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string_view suffix(end, size_t(text.data() + text.size() - end));
  int shift = 0;
  if (error == std::errc() && !suffix.empty()) {
    const size_t power = std::string_view("KMGT").find(char(suffix[0] & ~0x20));
    shift = power == std::string_view::npos ? -1 : 10 * int(power + 1);
    suffix.remove_prefix(1);
    if (suffix != "" && suffix != "B" && suffix != "iB") shift = -1;
  }
  if (error != std::errc() || shift < 0 || (value << shift) >> shift != value)
    fail_usage(std::string(option) + ": \"" + std::string(text) +
               "\" is not a number like 512, 64K or 4G");
  return value << shift;
}

int parse_resolution(std::string_view text) {
  const uint64_t n = parse_count(text, "--resolution");
  if (n < 8 || n > (1U << 20))
    fail_usage("--resolution: \"" + std::string(text) +
               "\" is not a power of two from 8 to 1M (1048576)");
  if (!std::has_single_bit(n))
    fail_usage("--resolution: " + std::string(text) + " is not a power of two: choose " +
               format_resolution(std::bit_floor(n)) + " or " + format_resolution(std::bit_ceil(n)));
  return std::countr_zero(n);
}

Box parse_bounds(const std::string& text, const char* option) {
  double v[6];
  int used = 0;
  const int n = std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf%n", &v[0], &v[1], &v[2], &v[3],
                            &v[4], &v[5], &used);
  bool good = n == 6 && used == int(text.size());
  for (int a = 0; good && a < 3; ++a) good = v[a] <= v[a + 3];
  if (!good)
    fail_usage(std::string(option) + ": \"" + text +
               "\" is not x0,y0,z0,x1,y1,z1 with the minimum first");
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

double parse_unit(const std::string& text) {
  for (const auto& [name, metres] : kLengths) {
    if (text == name) return metres;
  }
  fail_usage("--units: unknown unit \"" + text + "\": choose mm, cm, m, km, in or ft");
}

double parse_voxel_size(const std::string& text, double unit) {
  double size = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, size);
  const auto* length =
      std::find_if(std::begin(kLengths), std::end(kLengths),
                   [&, rest = std::string(stop, end)](const Length& l) { return rest == l.name; });
  if (error != std::errc() || (stop != end && length == std::end(kLengths)))
    fail_usage("--voxel-size: \"" + text + "\" is not a size like 0.5 or 5cm");
  if (size == 0) fail_usage("--voxel-size: 0 is not a size");
  if (stop == end) return size;
  if (unit == 0)
    fail_usage("--voxel-size: " + text +
               " needs --units, what one unit of the scene is; without it give the size in units "
               "of the scene");
  return size * length->metres / unit;
}

Point parse_origin(const std::string& text) {
  Point p;
  int used = 0;
  const int n = std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &p.x, &p.y, &p.z, &used);
  if (n != 3 || used != int(text.size()) || !std::isfinite(p.x + p.y + p.z))
    fail_usage("--origin: \"" + text + "\" is not x,y,z");
  return p;
}

GridCube parse_cube(const std::string& text) {
  double v[4];
  int used = 0;
  const int n = std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf%n", &v[0], &v[1], &v[2], &v[3], &used);
  if (n != 4 || used != int(text.size()) || !std::isfinite(v[0] + v[1] + v[2] + v[3]) || v[3] <= 0)
    fail_usage("--cube: \"" + text + "\" is not x,y,z,side with a side of more than 0");
  return {{v[0], v[1], v[2]}, v[3]};
}

std::string format_resolution(uint64_t n) {
  if (n >= (1U << 20) && n % (1U << 20) == 0) return std::to_string(n >> 20) + "M";
  if (n >= 1024 && n % 1024 == 0) return std::to_string(n >> 10) + "K";
  return std::to_string(n);
}

std::string format_bytes(uint64_t bytes) {
  static constexpr const char* kUnits[] = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  double value = double(bytes);
  int unit = 0;
  while (value >= 1024 && unit < 6) {
    value /= 1024;
    ++unit;
  }
  char text[32];
  std::snprintf(text, sizeof text, unit == 0 ? "%.0f %s" : "%.1f %s", value, kUnits[unit]);
  return text;
}

std::string format_count(uint64_t count) {
  std::string text = std::to_string(count);
  for (int at = int(text.size()) - 3; at > 0; at -= 3) text.insert(size_t(at), 1, ',');
  return text;
}

std::string format_count(uint64_t count, const std::string& noun) {
  return format_count(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string format_point(const Point& p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g)", p.x, p.y, p.z);
  return text;
}

std::string format_double(double value) {
  char text[40];
  const auto result = std::to_chars(text, text + sizeof text, value);
  return std::string(text, result.ptr);
}

ValueRange parse_iso(const std::string& text) {
  ValueRange range{};
  int used = 0;
  const int n = std::sscanf(text.c_str(), "%lf,%lf%n", &range.low, &range.high, &used);
  if (n != 2 || used != int(text.size()) || !(range.low <= range.high))
    fail_usage("--iso: \"" + text + "\" is not LOW,HIGH with the lower value first");
  return range;
}

}  // namespace svdag
