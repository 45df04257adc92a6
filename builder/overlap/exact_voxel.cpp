#include "builder/overlap/exact_voxel.h"

#include "builder/overlap/brick_tables.h"
#include "builder/overlap/exact.h"

namespace svdag {

bool column_reaches(const TriangleSetup& t, int k, const LatticePoint& corner, int fraction,
                    unsigned column) noexcept {
  // The critical corner of the square is the one farthest inwards.
  const int u = (k / 3 + 1) % 3, v = (k / 3 + 2) % 3;
  LatticePoint x = corner;
  x[u] += int64_t((column >> 2) + (t.edge_u[k] > 0)) << fraction;
  x[v] += int64_t((column & 3) + (t.edge_v[k] > 0)) << fraction;
  return exact_edge_sign(t, k, x) >= 0;
}

bool voxel_meets_plane(const TriangleSetup& t, const LatticePoint& corner, int fraction,
                       unsigned bit) noexcept {
  // The two extreme corners of the voxel are not strictly on one side.
  const uint8_t* at = kBrickTables.coordinate[bit];
  const LatticePoint low =
      corner + LatticePoint(int64_t(at[0]) << fraction, int64_t(at[1]) << fraction,
                            int64_t(at[2]) << fraction);
  LatticePoint farthest = low, nearest = low;
  for (int a = 0; a < 3; ++a) {
    (t.normal[a] > 0 ? farthest : nearest)[a] += int64_t(1) << fraction;
  }
  return exact_plane_sign(t, farthest) >= 0 && exact_plane_sign(t, nearest) <= 0;
}

bool column_centre_holds(const TriangleSetup& t, int k, const LatticePoint& corner, int fraction,
                         unsigned column) noexcept {
  const int u = (k / 3 + 1) % 3, v = (k / 3 + 2) % 3;
  LatticePoint x = corner;
  x[u] += int64_t(2 * (column >> 2) + 1) << (fraction - 1);
  x[v] += int64_t(2 * (column & 3) + 1) << (fraction - 1);
  return edge_holds_at(t, k, x);
}

bool edge_holds_at(const TriangleSetup& t, int k, const LatticePoint& x) noexcept {
  // One of the coefficients is nonzero: an edge that is a point in the projection belongs to a
  // projection of zero area, whose edge functions are off.
  const int u = (k / 3 + 1) % 3, v = (k / 3 + 2) % 3;
  const int sign = exact_edge_sign(t, k, x);
  if (sign != 0) return sign > 0;
  const double by_u = t.edge_u[k], by_v = t.edge_v[k];
  const double first = u < v ? by_u : by_v, second = u < v ? by_v : by_u;
  return first != 0 ? first > 0 : second > 0;
}

bool is_above_plane(const TriangleSetup& t, const LatticePoint& x) noexcept {
  const int sign = exact_plane_sign(t, x);
  if (sign != 0) return sign > 0;
  const double* n = t.normal;
  return n[0] != 0 ? n[0] > 0 : (n[1] != 0 ? n[1] > 0 : n[2] > 0);
}

bool end_is_above_plane(const TriangleSetup& t, const LatticePoint& corner, int fraction,
                        unsigned bit, int w, bool upper) noexcept {
  LatticePoint x = corner;
  for (int a = 0; a < 3; ++a)
    x[a] += int64_t(2 * kBrickTables.coordinate[bit][a] + 1) << (fraction - 1);
  x[w] += (upper ? int64_t(1) : int64_t(-1)) * (int64_t(1) << (fraction - 1));
  return is_above_plane(t, x);
}

}  // namespace svdag
