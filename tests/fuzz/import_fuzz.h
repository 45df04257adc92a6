// The common bodies of the fuzz targets of `svdag import`: any bytes are a DAG, or a list of
// voxels, or an Error (bad input), and nothing else.
#pragma once

#include <cstdlib>
#include <memory>
#include <set>
#include <string>

#include "io/dag/node_graph.h"
#include "io/voxel_source.h"
#include "streaming/error.h"
#include "tests/memory_file.h"

namespace svdag {

constexpr size_t kMostVisited = 1 << 20;  // a small file may stand for a lot

inline void expect_bad_input(const Error& error) {
  if (error.code() != ExitCode::kBadInput || std::string(error.what()).empty()) std::abort();
}

// Visits the nodes of each level once, as an import does.
inline int fuzz_graph(std::unique_ptr<NodeGraph> (*reader)(const File&), const uint8_t* data,
                      size_t size) {
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  try {
    const auto graph = reader(memory.file());
    const int levels = graph->grid().levels;
    if (levels < kMinLevels || levels > kMaxLevels) std::abort();
    std::set<uint32_t> nodes{graph->root()};
    for (int level = 0; level < levels - 2; ++level) {
      std::set<uint32_t> below;
      for (const uint32_t node : nodes) {
        for (const uint32_t child : graph->children(level, node)) {
          if (child != kNoChild) below.insert(child);
        }
      }
      nodes = std::move(below);
    }
    for (const uint32_t node : nodes) graph->brick(node);
  } catch (const Error& error) {
    expect_bad_input(error);
  }
  return 0;
}

inline int fuzz_voxels(VoxelPlace (*reader)(const File&, const VoxelSink&), const uint8_t* data,
                       size_t size) {
  struct Enough {};
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  size_t visited = 0;
  try {
    reader(memory.file(), [&](std::span<const Voxel> voxels) {
      for (const Voxel& voxel : voxels) {
        for (const uint32_t x : voxel) {
          if (x >= 1U << kMaxLevels) std::abort();
        }
      }
      if (voxels.empty()) std::abort();
      visited += voxels.size();
      if (visited > kMostVisited) throw Enough();
    });
  } catch (const Error& error) {
    expect_bad_input(error);
  } catch (Enough) {
  }
  return 0;
}

}  // namespace svdag
