// The memory that the control group we run in may take.
//
// A process is in one group of each hierarchy (/proc/self/cgroup), and every group above it limits
// it, too. Where a container shows its own group as the root of what is mounted, the path that the
// kernel tells leads nowhere, but its root does.
#pragma once

#include <cstdint>
#include <string>

namespace svdag {

// The least limit in bytes from the group up to the root, of version 2 (memory.max) or 1
// (memory.limit_in_bytes); UINT64_MAX if there is none. `groups`: what the kernel says of this
// process; `mounted`: where the hierarchies are.
uint64_t cgroup_memory_limit(const std::string& groups = "/proc/self/cgroup",
                             const std::string& mounted = "/sys/fs/cgroup");

}  // namespace svdag
