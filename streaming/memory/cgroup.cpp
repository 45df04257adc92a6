#include "streaming/memory/cgroup.h"

#include <algorithm>
#include <fstream>

namespace svdag {
namespace {

// The lowest limit of group `path` below `root` and of the groups above it; UINT64_MAX if they have
// none ("max").
uint64_t lowest_limit(const std::string& root, std::string path, const std::string& file) {
  uint64_t lowest = UINT64_MAX;
  for (;;) {
    uint64_t limit = 0;
    if (std::ifstream(root + path + "/" + file) >> limit && limit > 0)
      lowest = std::min(lowest, limit);
    const size_t slash = path.find_last_of('/');
    if (path.empty() || slash == std::string::npos) return lowest;
    path.erase(slash);
  }
}

}  // namespace

uint64_t cgroup_memory_limit(const std::string& groups, const std::string& mounted) {
  // The limits of the mounted roots apply even if `groups` does not list them.
  uint64_t lowest = std::min(lowest_limit(mounted, "", "memory.max"),
                             lowest_limit(mounted + "/memory", "", "memory.limit_in_bytes"));
  std::ifstream in(groups);
  for (std::string line; std::getline(in, line);) {  // NUMBER:CONTROLLERS:PATH
    const size_t first = line.find(':');
    const size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string path = line.substr(second + 1);
    if (controllers == ",,") {
      lowest = std::min(lowest, lowest_limit(mounted, path, "memory.max"));
    } else if (controllers.find(",memory,") != std::string::npos) {
      lowest = std::min(lowest, lowest_limit(mounted + "/memory", path, "memory.limit_in_bytes"));
    }
  }
  return lowest;
}

}  // namespace svdag
