// The common bodies of the fuzz targets of `svdag import`: any bytes are a DAG, a list of
// voxels, or an Error (bad input).
#pragma once

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "io/dag/graph/node_graph.h"
#include "io/dag/layers/layer_table.h"
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
    std::vector<uint32_t> nodes = graph->roots();
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

// `reader(file, sink, layers)` passes voxels, their labels if it gives layers, and maybe colours.
template <class Reader>
int fuzz_voxels(const Reader& reader, const uint8_t* data, size_t size) {
  struct Enough {};
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  size_t visited = 0;
  try {
    LayerTable layers;
    size_t labels_end = 0;  // one past the largest
    const VoxelSink sink = [&](std::span<const Voxel> voxels, std::span<const uint16_t> labels,
                               std::span<const Colour> colours) {
      uint32_t bits = 0;
      for (const Voxel& voxel : voxels) bits |= voxel[0] | voxel[1] | voxel[2];
      if (voxels.empty() || bits >> kMaxLevels != 0) std::abort();
      if (!labels.empty() && labels.size() != voxels.size()) std::abort();
      if (!colours.empty() && colours.size() != voxels.size()) std::abort();
      for (const uint16_t label : labels) labels_end = std::max<size_t>(labels_end, label + 1U);
      visited += voxels.size();
      if (visited > kMaxVisited) throw Enough();
    };
    const GridPlacement place = reader(memory.file(), sink, &layers);
    if (!layers.empty() && labels_end > layers.layers.size()) std::abort();
    if (place.resolution > uint64_t(1) << kMaxLevels) std::abort();
  } catch (const Error& error) {
    expect_bad_input(error);
  } catch (Enough) {
  }
  return 0;
}

}  // namespace svdag
