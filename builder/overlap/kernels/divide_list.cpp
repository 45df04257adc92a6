#include "builder/overlap/kernels/divide_list.h"

#include <algorithm>
#include <bit>

namespace svdag {

void divide_list(const TriangleList& list, const Cube& cube, int levels,
                 const OverlapConfig& config, std::array<TriangleList, 8>* children) {
  constexpr size_t kBatch = 64;  // kernel results that fit in the L1 cache
  std::array<ChildOverlap, kBatch> overlaps;
  const LatticePoint corner = cube.corner(levels);
  const int64_t side = int64_t(1) << cube.side_log2(levels);
  for (TriangleList& child : *children) child.clear();
  for (size_t begin = 0; begin < list.size(); begin += kBatch) {
    const size_t count = std::min(kBatch, list.size() - begin);
    config.kernels->children(&list[begin], count, corner, side, overlaps.data());
    for (size_t i = 0; i < count; ++i) {
      const TriangleSetup* triangle = list[begin + i].triangle;
      for (unsigned left = overlaps[i].touched; left != 0; left &= left - 1) {
        const int c = std::countr_zero(left);
        EdgeMask edges = EdgeMask(overlaps[i].edges[c]);
        if (config.covering) edges = needed_edges(*triangle, edges);
        (*children)[size_t(c)].push_back({triangle, edges});
      }
    }
  }
}

}  // namespace svdag
