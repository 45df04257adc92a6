// Compares the disk space that a plan predicts with what is free, before the work begins.
//
// A prediction is off by up to a factor of two, a compressing file system holds more than it
// reports, and one with quotas less. So only a disk that cannot hold half is refused, as in a bake
// (builder/workspace/disk_need.h); one that cannot hold all gets a warning.
#pragma once

#include <cstdint>
#include <string>

namespace svdag {

// `who` writes about `bytes` to `folder`. Throws Error (kOutput).
void check_disk(const std::string& folder, uint64_t bytes, const std::string& who);

}  // namespace svdag
