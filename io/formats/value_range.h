// The range of values of a float grid that count as set (--iso=LOW,HIGH).
#pragma once

#include <string>

namespace svdag {

struct ValueRange {
  double low, high;
};

// Parses "LOW,HIGH", which may be -inf and inf; anything else is an Error (kUsage).
ValueRange parse_iso(const std::string& text);

}  // namespace svdag
