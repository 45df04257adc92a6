// Fast parsing of the usual lines of an OBJ file, "v 1.5 2 -3" and "f 1 2 3" or "f 1/4/7 2/5/8
// 3/6/9", directly in the window.
//
// Both functions read one line behind its statement and return where they stopped in it, or null
// for everything that is not plain: tabs, signs of indices, many corners, the end of the window,
// each error. The reader then takes the same line word by word, which decides what it means.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "io/triangle.h"
#include "io/values/decimal.h"

namespace svdag {

struct PlainFace {
  std::array<uint64_t, 8> index;  // counted from 0
  size_t corners = 0;
};

namespace obj_plain {
constexpr std::ptrdiff_t kReach = 64;  // max bytes of a corner or a number

inline bool ends_line(char c) {
  return c == '\n' || c == '\r';
}
inline const char* skip_spaces(const char* p, const char* end) {
  while (p != end && *p == ' ') ++p;
  return end - p < kReach ? nullptr : p;
}
// Over "/2/3" or "//3"; at most 7 digits each.
inline const char* skip_references(const char* p) {
  for (int i = 0; i < 2 && *p == '/'; ++i) p += 1 + leading_digits(p + 1).count;
  return p;
}
}  // namespace obj_plain

// What follows x, y, z is left for the reader to skip.
inline const char* read_plain_vertex(std::string_view text, Point* vertex) {
  const char *p = text.data(), *end = p + text.size();
  for (int a = 0; a < 3; ++a) {
    p = obj_plain::skip_spaces(p, end);
    if (p == nullptr) return nullptr;
    const auto [stop, error] = parse_decimal(p, end, (*vertex)[a]);
    if (error != std::errc{} || stop == end) return nullptr;
    if (*stop != ' ' && !obj_plain::ends_line(*stop)) return nullptr;
    p = stop;
  }
  return p;
}

// Every index names one of `vertices` vertices.
inline const char* read_plain_face(std::string_view text, uint64_t vertices, PlainFace* face) {
  const char *p = text.data(), *end = p + text.size();
  for (face->corners = 0;;) {
    p = obj_plain::skip_spaces(p, end);
    if (p == nullptr) return nullptr;
    if (obj_plain::ends_line(*p)) return p;
    const Digits digits = leading_digits(p);
    const uint64_t index = digits.value - 1;  // without digits: like index 0, which is rejected
    if (digits.count == 8 || index >= vertices) return nullptr;
    p = obj_plain::skip_references(p + digits.count);
    const bool fits = face->corners < face->index.size();
    if (!fits || (*p != ' ' && !obj_plain::ends_line(*p))) return nullptr;
    face->index[face->corners++] = index;
  }
}

}  // namespace svdag
