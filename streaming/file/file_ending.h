// Tests the extension of a file name, ignoring case.
#pragma once

#include <string_view>

namespace svdag {

// True if `name` ends with `ending`, which is in lower case and includes the dot: ".png".
inline bool has_ending(std::string_view name, std::string_view ending) {
  if (name.size() < ending.size()) return false;
  name.remove_prefix(name.size() - ending.size());
  for (size_t i = 0; i < name.size(); ++i) {
    const bool upper = name[i] >= 'A' && name[i] <= 'Z';
    if ((upper ? char(name[i] - 'A' + 'a') : name[i]) != ending[i]) return false;
  }
  return true;
}

}  // namespace svdag
