#include "verify/report/report_text.h"

#include <cstdio>
#include <iterator>

namespace svdag {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string formatted(const char* pattern, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

std::string short_count(uint64_t count) {
  constexpr const char* kUnits[] = {"", " K", " M", " G", " T", " P"};
  double value = double(count);
  size_t unit = 0;
  while (value >= 999.5 && unit + 1 < std::size(kUnits)) {
    value /= 1000;
    ++unit;
  }
  return formatted(unit == 0 || value >= 99.95 ? "%.0f" : "%.3g", value) + kUnits[unit];
}

}  // namespace svdag
