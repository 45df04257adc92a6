// The memory limit of this process's control group.
//
// A process is in one group of each hierarchy (/proc/self/cgroup), and every group above it limits
// it, too. In a container whose own group is the mounted root, the path in /proc/self/cgroup does
// not exist, but the root does.
#pragma once

#include <cstdint>
#include <string>

namespace svdag {

// Returns the lowest limit in bytes from the group up to the root, of cgroups version 2
// (memory.max) or 1 (memory.limit_in_bytes); UINT64_MAX without a limit. `groups`: file that lists
// the groups of this process. `mounted`: folder under which the hierarchies are mounted.
uint64_t cgroup_memory_limit(const std::string& groups = "/proc/self/cgroup",
                             const std::string& mounted = "/sys/fs/cgroup");

}  // namespace svdag
