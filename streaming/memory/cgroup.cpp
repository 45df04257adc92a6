#include "streaming/memory/cgroup.h"

#include <algorithm>
#include <fstream>

namespace svdag {
namespace {

// The lowest limit of group `path` below `root` and of the groups above it. "max" is no limit.
uint64_t least_limit(const std::string& root, std::string path, const std::string& file) {
  uint64_t least = UINT64_MAX;
  for (;;) {
    uint64_t limit = 0;
    if (std::ifstream(root + path + "/" + file) >> limit && limit > 0)
      least = std::min(least, limit);
    const size_t slash = path.find_last_of('/');
    if (path.empty() || slash == std::string::npos) return least;
    path.erase(slash);
  }
}

}  // namespace

uint64_t cgroup_memory_limit(const std::string& groups, const std::string& mounted) {
  // What is limited whether or not the kernel names it.
  uint64_t least = std::min(least_limit(mounted, "", "memory.max"),
                            least_limit(mounted + "/memory", "", "memory.limit_in_bytes"));
  std::ifstream in(groups);
  for (std::string line; std::getline(in, line);) {  // NUMBER:CONTROLLERS:PATH
    const size_t first = line.find(':');
    const size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string path = line.substr(second + 1);
    if (controllers == ",,") {
      least = std::min(least, least_limit(mounted, path, "memory.max"));
    } else if (controllers.find(",memory,") != std::string::npos) {
      least = std::min(least, least_limit(mounted + "/memory", path, "memory.limit_in_bytes"));
    }
  }
  return least;
}

}  // namespace svdag
