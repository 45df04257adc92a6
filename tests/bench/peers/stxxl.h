// The external sort of STXXL (Dementiev, Kettner, Sanders 2008), for comparison.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "tests/bench/sort_keys.h"

namespace svdag::bench {

// Configures its disk: `bytes` in the file `path` (O_DIRECT), or in memory if `path` is empty. Call
// once per process, before the first sort; the file is removed when the process ends.
void stxxl_disk(const std::string& path, uint64_t bytes);
// Pushes the keys, sorts, and pulls them, with `memory` bytes.
SortCost stxxl_sort(std::span<const Key> keys, uint64_t memory, const Digest& expected);

}  // namespace svdag::bench
