#include "builder/split/open_edges.h"

#include <algorithm>
#include <cstdlib>
#include <unordered_map>

#include "io/lattice.h"
#include "io/scene/boundary_chain.h"
#include "io/units.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

constexpr size_t kBuckets = 1 << 16;
constexpr size_t kMaxEnds = 1 << 20;
constexpr size_t kShownParts = 3;

// What is left of the ends of edges at one point of one line.
struct OpenEnd {
  int64_t count = 0;
  uint64_t order = 0;  // of its first edge in the scene
  Point point{0};
  uint32_t part = 0;
};

// The hash of an end is one already; its first half chose the bucket.
struct SecondHalf {
  size_t operator()(const HashSum::Hash& hash) const noexcept { return size_t(hash[1]); }
};

template <class Visit>
void stream_ends(const Scene& scene, const Grid& grid, const Visit& visit) {
  const Lattice lattice(grid);
  scene.stream([&](const TriangleBatch& batch) {
    for (const Triangle& triangle : batch.triangles) {
      LatticeTriangle snapped;
      for (size_t i = 0; i < 3; ++i) snapped.v[i] = lattice.snap(triangle.v[i]);
      BoundaryChain::for_each_end(snapped, [&](const BoundaryChain::EdgeEnd& end) {
        const auto at = std::ranges::find(snapped.v, end.point) - snapped.v.begin();
        visit(batch, end, triangle.v[size_t(at)]);
      });
    }
  });
}

}  // namespace

OpenEdges find_open_edges(const Scene& scene, const Grid& grid) {
  std::vector<BoundaryChain> buckets(kBuckets);
  BoundaryChain all;
  stream_ends(scene, grid,
              [&](const TriangleBatch&, const BoundaryChain::EdgeEnd& end, const Point&) {
                buckets[end.hash[0] % kBuckets].add(end);
                all.add(end);
              });
  OpenEdges open;
  open.closed_mod_2 = all.is_closed_mod_2();
  std::unordered_map<HashSum::Hash, OpenEnd, SecondHalf> ends;
  std::vector<std::string> parts;
  uint64_t order = 0;
  stream_ends(scene, grid,
              [&](const TriangleBatch& batch, const BoundaryChain::EdgeEnd& end, const Point& p) {
                ++order;
                if (buckets[end.hash[0] % kBuckets].is_closed()) return;
                if (parts.empty() || parts.back() != batch.mesh) parts.emplace_back(batch.mesh);
                if (ends.size() == kMaxEnds && !ends.contains(end.hash)) {
                  open.all_counted = false;
                  return;
                }
                OpenEnd& entry = ends[end.hash];
                if (entry.order == 0) entry = {0, order, p, uint32_t(parts.size() - 1)};
                entry.count += end.adds ? 1 : -1;
              });
  std::vector<OpenEnd> left;
  for (const auto& [hash, end] : ends) {
    if (end.count != 0) left.push_back(end);
  }
  std::ranges::sort(left, {}, &OpenEnd::order);
  uint64_t count = 0;
  for (const OpenEnd& end : left) {
    count += uint64_t(std::abs(end.count));
    if (std::ranges::find(open.parts, parts[end.part]) == open.parts.end())
      open.parts.push_back(parts[end.part]);
  }
  open.edges = count / (open.closed_mod_2 ? 4 : 2);
  if (!left.empty()) open.first = left.front().point;
  return open;
}

std::string describe(const OpenEdges& open) {
  std::string text = (open.all_counted ? "" : "more than ") +
                     format_count(open.edges, open.closed_mod_2 ? "edge" : "open edge");
  std::string names;
  size_t shown = 0;
  for (const std::string& part : open.parts) {
    if (part.empty() || shown == kShownParts) continue;
    names += (shown++ == 0 ? "" : ", ") + printable(part);
  }
  if (shown > 0) text += " in " + names + (open.parts.size() > shown ? " and others" : "");
  return text + ", the first at " + format_point(open.first);
}

}  // namespace svdag
