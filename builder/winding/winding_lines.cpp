#include "builder/winding/winding_lines.h"

#include <algorithm>

#include "builder/winding/crossing.h"
#include "streaming/error.h"

namespace svdag {

WindingLines::WindingLines(int levels, const Cube& root, int level)
    : levels_(levels),
      level_(level),
      side_log2_(level - root.level),
      first_cube_(root.coordinate << int64_t(level - root.level)),
      first_(first_centre(root.corner(levels), fraction_bits(levels))),
      side_(int64_t(1) << Cube{level, {}}.side_log2(levels)) {
  SVDAG_ASSERT(side_log2_ >= 0 && side_log2_ <= kMaxSideLog2);
}

void WindingLines::for_each_change(const LatticeTriangle& triangle, const Visit& visit) const {
  // The points in the triangle's box: low .. high on each axis; at most one axis may have none.
  const LatticeBox box = box_of(triangle);
  const int log2 = Cube{level_, {}}.side_log2(levels_);
  int64_t low[3], high[3];
  int empty = 0;
  for (int a = 0; a < 3; ++a) {
    low[a] = std::max<int64_t>(0, -((first_[a] - box.min[a]) >> log2));
    high[a] = std::min((int64_t(1) << side_log2_) - 1, (box.max[a] - first_[a]) >> log2);
    empty += low[a] > high[a];
  }
  if (empty > 1) return;
  const TriangleSetup setup = make_setup(triangle);
  for (int w = 0; w < 3; ++w) {
    const int u = (w + 1) % 3, v = (w + 2) % 3;
    if (setup.normal[w] == 0 || low[u] > high[u] || low[v] > high[v]) continue;
    // Lines along y are those with z = 0, lines along x those with y = z = 0.
    if ((w < 2 && low[2] > 0) || (w < 1 && low[1] > 0)) continue;
    const int64_t last[3] = {high[0], w < 1 ? 0 : high[1], w < 2 ? 0 : high[2]};
    visit_lines(setup, w, low, last, visit);
  }
}

// The lines along w through the points low .. high on the other axes.
void WindingLines::visit_lines(const TriangleSetup& t, int w, const int64_t low[3],
                               const int64_t high[3], const Visit& visit) const {
  const int u = (w + 1) % 3, v = (w + 2) % 3;
  const int64_t last = (int64_t(1) << side_log2_) - 1;
  LatticePoint at;
  for (at[u] = low[u]; at[u] <= high[u]; ++at[u]) {
    for (at[v] = low[v]; at[v] <= high[v]; ++at[v]) {
      const auto point = [&](int64_t k) {
        LatticePoint p;
        p[u] = first_[u] + at[u] * side_;
        p[v] = first_[v] + at[v] * side_;
        p[w] = first_[w] + k * side_;
        return p;
      };
      if (!is_crossed_by_line(t, t.edges, w, point(0))) continue;
      const bool front = is_in_front(t, point(0));
      if (is_in_front(t, point(last)) == front) continue;
      int64_t same = 0, other = last;  // on the two sides of the plane
      while (other - same > 1) {
        const int64_t middle = (same + other) / 2;
        (is_in_front(t, point(middle)) == front ? same : other) = middle;
      }
      at[w] = other;
      visit(index(at), front ? 1 : -1);
    }
  }
}

int WindingLines::ray_change(const LatticeTriangle& triangle) const {
  const LatticeBox box = box_of(triangle);
  for (int a = 0; a < 3; ++a) {
    if (box.min[a] > first_[a] || (a < 2 && box.max[a] < first_[a])) return 0;
  }
  const TriangleSetup t = make_setup(triangle);
  if (!is_crossed_by_line(t, t.edges, 2, first_)) return 0;
  return int(t.normal[2] < 0) - int(is_in_front(t, first_));
}

void WindingLines::sum(std::span<int32_t> steps) const {
  const size_t n = size_t(1) << side_log2_;
  for (size_t i = 0; i < n; ++i) {
    if (i > 0) steps[i * n * n] += steps[(i - 1) * n * n];
    for (size_t j = 0; j < n; ++j) {
      int32_t* const line = &steps[(i * n + j) * n];
      if (j > 0) *line += *(line - n);
      for (size_t k = 1; k < n; ++k) line[k] += line[k - 1];
    }
  }
}

}  // namespace svdag
