// Packs a file for shipping: about 30 % of the plain file, in zstd frames that are checked one by
// one. The same file and level give the same bytes with the same version of zstd; any version
// unpacks them.
#pragma once

#include <cstdint>
#include <string>

#include "io/dag/dag_file.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/process/executor.h"

namespace svdag {

constexpr int kDefaultPackLevel = 5, kMaxPackLevel = 19;

// Writes a file in the plain layout to `path`; `level`: of zstd, 1 to kMaxPackLevel. Returns the
// size of the output in bytes. `budget`: for a bit per word of a level; Error (kMemory) if it has
// too little.
uint64_t pack(const DagFile& plain, const std::string& path, int level, MemoryBudget* budget,
              Executor* executor);

}  // namespace svdag
