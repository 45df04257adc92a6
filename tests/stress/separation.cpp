#include "tests/stress/separation.h"

#include <algorithm>
#include <tuple>

#include "tests/stress/centre_lines.h"

namespace svdag {
namespace {

auto key(const LatticePoint& p) {
  return std::tuple(p.x, p.y, p.z);
}

}  // namespace

Separation& Separation::operator+=(const Separation& other) {
  tested += other.tested;
  leaks += other.leaks;
  crossed += other.crossed;
  windows += other.windows;
  return *this;
}

bool is_closed(std::span<const LatticeTriangle> mesh) {
  std::vector<std::pair<LatticePoint, LatticePoint>> edges;
  for (const LatticeTriangle& t : mesh) {
    for (size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(t.v[i], t.v[(i + 1) % 3],
                                      [](const auto& p, const auto& q) { return key(p) < key(q); });
      if (a != b) edges.emplace_back(a, b);
    }
  }
  std::sort(edges.begin(), edges.end(), [](const auto& e, const auto& f) {
    return std::tuple(key(e.first), key(e.second)) < std::tuple(key(f.first), key(f.second));
  });
  for (size_t i = 0, end; i < edges.size(); i = end) {
    for (end = i; end < edges.size() && edges[end] == edges[i]; ++end) {
    }
    if ((end - i) % 2 != 0) return false;
  }
  return true;
}

VoxelRegion inside_of(std::span<const LatticeTriangle> mesh, const VoxelBox& box, int shift) {
  VoxelRegion inside(box);
  for (const LatticeTriangle& t : mesh) {
    bool beside = false;  // cannot cross a centre line above the lowest centre of the window
    for (int a = 0; a < 3; ++a) {
      const auto [low, high] = std::minmax({t.v[0][a], t.v[1][a], t.v[2][a]});
      beside = beside || high < box.min[a] << shift || (a < 2 && low > box.max[a] << shift);
    }
    if (!beside) flip_below(t, shift, &inside);
  }
  return inside;
}

Separation count_leaks(const VoxelRegion& set, const VoxelRegion& inside, Rule rule) {
  VoxelRegion empty_inside(set.box()), empty_outside(set.box());
  const VoxelBox& box = set.box();
  for (int64_t x = box.min.x; x < box.max.x; ++x) {
    for (int64_t y = box.min.y; y < box.max.y; ++y) {
      const uint64_t empty = ~set.row(x, y) & set.full_row();
      empty_inside.row(x, y) = empty & inside.row(x, y);
      empty_outside.row(x, y) = empty & ~inside.row(x, y);
    }
  }
  const VoxelRegion reached =
      rule == Rule::kThin ? empty_outside.dilated_by_faces() : empty_outside.dilated();
  Separation result;
  result.tested = empty_inside.count() + empty_outside.count();
  result.leaks = empty_inside.count() - empty_inside.count_without(reached);
  result.crossed = empty_inside.count() != 0 && empty_outside.count() != 0;
  result.windows = 1;
  return result;
}

}  // namespace svdag
