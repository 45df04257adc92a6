// Triangles in memory, prepared for the walk: for the overlap tests and for their shares in cubes.
#pragma once

#include <cstdint>
#include <vector>

#include "builder/colours/cube_share.h"
#include "builder/overlap/triangle_list.h"
#include "streaming/process/executor.h"

namespace svdag {

struct PreparedTriangles {
  static constexpr uint64_t kBytes = sizeof(PaintedTriangle) + sizeof(TriangleSetup) +
                                     sizeof(ShareSetup) + sizeof(uint64_t) +
                                     8 * sizeof(ListedTriangle);
  static constexpr uint64_t kVarying = UINT64_MAX;

  std::vector<TriangleSetup> setups;
  std::vector<ShareSetup> shares;
  std::vector<uint64_t> one_colours;  // packed, or kVarying

  PreparedTriangles(const std::vector<PaintedTriangle>& triangles, const Paints& paints,
                    int side_log2, Executor* executor);

  size_t index_of(const ListedTriangle& entry) const {
    return size_t(entry.triangle - setups.data());
  }
  // The packed colour that all triangles of a list have, or kVarying.
  uint64_t one_colour_of(const TriangleList& list) const {
    const uint64_t first = one_colours[index_of(list.front())];
    for (const ListedTriangle& entry : list) {
      if (one_colours[index_of(entry)] != first) return kVarying;
    }
    return first;
  }
  TriangleList all() const {
    TriangleList list;
    list.reserve(setups.size());
    for (const TriangleSetup& setup : setups) list.push_back({&setup, setup.edges});
    return list;
  }
};

}  // namespace svdag
