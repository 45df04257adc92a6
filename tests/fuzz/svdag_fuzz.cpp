// Arbitrary bytes as a .svdag, unchanged and with repaired checksums: an Error, or a file
// whose every node can be walked.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "io/dag/check.h"
#include "io/dag/colours/chunk_codec.h"
#include "io/dag/colours/dag_colours.h"
#include "io/dag/compact/compact_check.h"
#include "io/dag/dag_view.h"
#include "io/dag/layers/layer_table.h"
#include "streaming/error.h"
#include "tests/memory_file.h"
#include "tests/repair_checksums.h"

namespace svdag {
namespace {

// Visits each node once, level by level; the sanitizers watch the reads.
uint64_t walk(const DagView& dag) {
  uint64_t bricks = 0;
  std::vector<uint32_t> nodes;
  if (!dag.empty()) nodes.push_back(0);
  for (uint32_t level = 0; level < dag.brick_level(); ++level) {
    std::vector<uint32_t> below;
    for (const uint32_t node : nodes) {
      for (unsigned c = 0; c < 8; ++c) {
        const uint32_t child = dag_child(dag, level, node, c);
        if (child != kNoChild) below.push_back(child);
      }
    }
    std::sort(below.begin(), below.end());
    below.erase(std::unique(below.begin(), below.end()), below.end());
    nodes = std::move(below);
  }
  for (const uint32_t brick : nodes) bricks += dag.bricks[brick] != 0;
  return bricks;
}

// The first and last colour of every entry; the decoder sees the others.
void look_up_colours(const std::string& path) {
  try {
    const DagFile file = DagFile::open(path);
    MemoryBudget budget(uint64_t(1) << 28);
    const DagColours colours(file, &budget);
    const ColourView& view = colours.view();
    std::vector<uint32_t> chunk;
    for (uint64_t i = 0; i < view.entry_count; ++i) {
      const uint64_t first = view.entries[i].first;
      const uint64_t end =
          i + 1 < view.entry_count ? view.entries[i + 1].first : file.header().colour_count;
      const uint32_t a = colour_at(view, first), b = colour_at(view, end - 1);
      if ((view.entries[i].value & kChunkEntry) == 0) continue;
      chunk.resize(end - first);
      decode_chunk(view.chunks + (view.entries[i].value & ~kChunkEntry), chunk);
      if (chunk.front() != a || chunk.back() != b) std::abort();
    }
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput && error.code() != ExitCode::kMemory) std::abort();
  }
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
  const Header& header = *reinterpret_cast<const Header*>(aligned.data());
  decode_layers(header,
                std::as_bytes(std::span(bytes)).subspan(header.layers_offset, header.layers_bytes));
  const bool compact = header.layout == uint32_t(Layout::kCompact);
  if (!compact || !CompactCheck(aligned.data()).run()) walk(dag_view(aligned.data()));
  if (has_colours(header)) look_up_colours(memory.file().path());
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
