// --iso=LOW,HIGH: the values of a float grid that count as set.
#pragma once

#include <string>

namespace svdag {

struct ValueRange {
  double low, high;
};

// "LOW,HIGH", where -inf and inf are numbers too; anything else is an Error (kUsage).
ValueRange parse_iso(const std::string& text);

}  // namespace svdag
