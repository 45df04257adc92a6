#include "builder/colours/prepared_triangles.h"

#include <algorithm>

namespace svdag {

PreparedTriangles::PreparedTriangles(const std::vector<PaintedTriangle>& triangles,
                                     const Paints& paints, int side_log2, Executor* executor) {
  setups.resize(triangles.size());
  constexpr size_t kAtOnce = 4096;
  executor->for_each((triangles.size() + kAtOnce - 1) / kAtOnce, [&](size_t, size_t part) {
    const size_t end = std::min(triangles.size(), (part + 1) * kAtOnce);
    for (size_t i = part * kAtOnce; i < end; ++i) setups[i] = make_setup(triangles[i].triangle());
  });
  shares.reserve(triangles.size());
  one_colours.reserve(triangles.size());
  for (size_t i = 0; i < triangles.size(); ++i) {
    const PaintedTriangle& t = triangles[i];
    shares.emplace_back(t, setups[i], paints, side_log2);
    const auto& colour = t.corners[0].colour;
    one_colours.push_back(t.has_one_colour()
                              ? uint64_t(colour[0]) << 32 | uint64_t(colour[1]) << 16 | colour[2]
                              : kVarying);
  }
}

}  // namespace svdag
