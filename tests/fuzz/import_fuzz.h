// The common bodies of the fuzz targets of `svdag import`: any bytes are a DAG, a list of
// voxels, or an Error (bad input).
#pragma once

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "io/dag/node_graph.h"
#include "io/voxel_source.h"
#include "streaming/error.h"
#include "tests/memory_file.h"

namespace svdag {

constexpr size_t kMaxVisited = 1 << 20;  // a small file may represent many nodes

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
    std::vector<uint32_t> nodes{graph->root()};
    for (int level = 0; level < levels - 2; ++level) {
      std::vector<uint32_t> below;
      for (const uint32_t node : nodes) {
        for (const uint32_t child : graph->children(level, node)) {
          if (child != kNoChild) below.push_back(child);
        }
      }
      std::sort(below.begin(), below.end());
      below.erase(std::unique(below.begin(), below.end()), below.end());
      nodes = std::move(below);
    }
    for (const uint32_t node : nodes) graph->brick(node);
  } catch (const Error& error) {
    expect_bad_input(error);
  }
  return 0;
}

inline int fuzz_voxels(GridPlacement (*reader)(const File&, const VoxelSink&), const uint8_t* data,
                       size_t size) {
  struct Enough {};
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  size_t visited = 0;
  try {
    const GridPlacement place = reader(memory.file(), [&](std::span<const Voxel> voxels) {
      uint32_t bits = 0;
      for (const Voxel& voxel : voxels) bits |= voxel[0] | voxel[1] | voxel[2];
      if (voxels.empty() || bits >> kMaxLevels != 0) std::abort();
      visited += voxels.size();
      if (visited > kMaxVisited) throw Enough();
    });
    if (place.resolution > uint64_t(1) << kMaxLevels) std::abort();
  } catch (const Error& error) {
    expect_bad_input(error);
  } catch (Enough) {
  }
  return 0;
}

}  // namespace svdag
