#include <algorithm>
#include <bit>

#include "builder/overlap/overlap.h"

namespace svdag {
namespace {

// Children with bit (x, y, z) of axis a equal to 1.
constexpr uint8_t kUpper[3] = {0b11110000, 0b11001100, 0b10101010};

// Removes the children that are strictly on one side of the plane.
uint8_t children_on_plane(const TriangleSetup& t, const LatticePoint& corner, double half,
                          uint8_t children) noexcept {
  const double* n = t.normal;
  const LatticePoint r = corner - t.triangle.v[0];
  const double f = n[0] * double(r.x) + n[1] * double(r.y) + n[2] * double(r.z);
  const double error = filter_error(t, 4 * half);
  const double sx = n[0] * half, sy = n[1] * half, sz = n[2] * half;
  const double high = (std::max(sx, 0.0) + std::max(sy, 0.0)) + std::max(sz, 0.0);
  const double low = (std::min(sx, 0.0) + std::min(sy, 0.0)) + std::min(sz, 0.0);
  for (unsigned left = children; left != 0; left &= left - 1) {
    const unsigned c = unsigned(std::countr_zero(left));
    const double offset = ((c & 4 ? sx : 0.0) + (c & 2 ? sy : 0.0)) + (c & 1 ? sz : 0.0);
    if (f + (offset + high) < -error || f + (offset + low) > error)
      children = uint8_t(children & ~(1U << c));
  }
  return children;
}

// The children that project along w to the quarters `quarters` of the cube's square (bit 2i + j:
// half i of axis u, half j of axis v).
uint8_t children_of_quarters(int w, unsigned quarters) noexcept {
  const uint8_t u = kUpper[(w + 1) % 3], v = kUpper[(w + 2) % 3];
  unsigned children = 0;
  if (quarters & 1) children |= uint8_t(~u & ~v);
  if (quarters & 2) children |= uint8_t(~u & v);
  if (quarters & 4) children |= uint8_t(u & ~v);
  if (quarters & 8) children |= uint8_t(u & v);
  return uint8_t(children);
}

struct EdgeVerdict {
  uint8_t outside;  // children that the edge separates from the triangle
  uint8_t inside;   // children in which the edge function holds everywhere
};

EdgeVerdict children_at_edge(const TriangleSetup& t, int k, const LatticePoint& corner, double half,
                             double error) noexcept {
  const int w = k / 3, u = (w + 1) % 3, v = (w + 2) % 3;
  const LatticePoint r = corner - t.triangle.v[t.from[k % 3]];
  const double f = t.edge_u[k] * double(r[u]) + t.edge_v[k] * double(r[v]);
  const double su = t.edge_u[k] * half, sv = t.edge_v[k] * half;
  const double high = std::max(su, 0.0) + std::max(sv, 0.0);
  const double low = std::min(su, 0.0) + std::min(sv, 0.0);
  const double offset[4] = {0.0, sv, su, su + sv};
  unsigned outside = 0, inside = 0;
  for (unsigned q = 0; q < 4; ++q) {
    outside |= unsigned(f + (offset[q] + high) < -error) << q;
    inside |= unsigned(f + (offset[q] + low) > error) << q;
  }
  return {children_of_quarters(w, outside), children_of_quarters(w, inside)};
}

}  // namespace

ChildOverlap overlap_children(const ListedTriangle& entry, const LatticePoint& corner,
                              int64_t side) noexcept {
  const TriangleSetup& t = *entry.triangle;
  const double half = double(side / 2);
  ChildOverlap result;
  const LatticePoint middle = corner + LatticePoint(side / 2);
  result.touched = children_in_box(t.box, middle.x, middle.y, middle.z);
  result.touched = children_on_plane(t, corner, half, result.touched);
  std::fill(std::begin(result.edges), std::end(result.edges), entry.edges);
  const double error = filter_error(t, 4 * half);
  for (unsigned left = entry.edges; left != 0 && result.touched != 0; left &= left - 1) {
    const int k = std::countr_zero(left);
    const EdgeVerdict verdict = children_at_edge(t, k, corner, half, error);
    result.touched = uint8_t(result.touched & ~verdict.outside);
    for (unsigned in = verdict.inside; in != 0; in &= in - 1) {
      result.edges[std::countr_zero(in)] &= ~(1U << k);
    }
  }
  return result;
}

}  // namespace svdag
