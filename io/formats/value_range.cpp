#include "io/formats/value_range.h"

#include <cstdio>

#include "streaming/error.h"

namespace svdag {

ValueRange parse_iso(const std::string& text) {
  ValueRange range{};
  int used = 0;
  const int n = std::sscanf(text.c_str(), "%lf,%lf%n", &range.low, &range.high, &used);
  if (n != 2 || used != int(text.size()) || !(range.low <= range.high))
    fail_usage("--iso: \"" + text + "\" is not LOW,HIGH with the lower value first");
  return range;
}

}  // namespace svdag
