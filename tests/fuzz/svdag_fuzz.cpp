// Arbitrary bytes as a .svdag, as they are and with their checksums repaired: an Error, or a file
// whose every node can be walked.
#include <cstdlib>
#include <set>
#include <utility>
#include <vector>

#include "io/dag/check.h"
#include "io/dag/dag_view.h"
#include "streaming/error.h"
#include "tests/memory_file.h"
#include "tests/repair_checksums.h"

namespace svdag {
namespace {

// Visits each node once; the sanitizers watch the reads.
uint64_t walk(const DagView& dag) {
  uint64_t bricks = 0;
  std::set<std::pair<uint32_t, uint32_t>> seen;
  std::vector<std::pair<uint32_t, uint32_t>> open;  // (level, node)
  if (!dag.empty()) open.emplace_back(0, 0);
  while (!open.empty()) {
    const auto [level, node] = open.back();
    open.pop_back();
    if (!seen.emplace(level, node).second) continue;
    if (level == dag.brick_level()) {
      bricks += dag.bricks[node] != 0;
      continue;
    }
    for (unsigned c = 0; c < 8; ++c) {
      const uint32_t child = dag_child(dag, level, node, c);
      if (child != kNoChild) open.emplace_back(level + 1, child);
    }
  }
  return bricks;
}

void try_file(const std::string& bytes) {
  const MemoryFile memory(bytes);
  try {
    check_dag(memory.file());
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput || std::string(error.what()).empty()) std::abort();
    return;
  }
  std::vector<uint64_t> aligned(bytes.size() / 8 + 1);
  std::memcpy(aligned.data(), bytes.data(), bytes.size());
  walk(dag_view(aligned.data()));
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  svdag::try_file(bytes);
  svdag::repair_checksums(&bytes);
  svdag::try_file(bytes);
  return 0;
}
