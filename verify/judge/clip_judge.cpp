#include "verify/judge/clip_judge.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

#include "verify/judge/judge_cells.h"

namespace svdag {
namespace {

using Int256 = boost::multiprecision::int256_t;

constexpr int64_t kNone = std::numeric_limits<int64_t>::max();

// The axis that gives few and long columns; any axis is correct. It is the smallest component of
// the normal or, if tied (walls, segments), the longest side of the box. Doubles suffice.
int best_axis(const LatticeTriangle& t) {
  const Point a(t.v[1] - t.v[0]), b(t.v[2] - t.v[0]);
  const Point n(std::abs(a.y * b.z - a.z * b.y), std::abs(a.z * b.x - a.x * b.z),
                std::abs(a.x * b.y - a.y * b.x));
  int best = 0;
  double best_side = 0;
  for (int w = 0; w < 3; ++w) {
    const double side = std::max({0.0, a[w], b[w]}) - std::min({0.0, a[w], b[w]});
    if (w == 0 || n[w] < n[best] || (n[w] == n[best] && side > best_side)) {
      best = w;
      best_side = side;
    }
  }
  return best;
}

}  // namespace

// Clips one triangle by the columns of one window. Int must hold every intermediate value.
template <class Int>
class ColumnClip {
 public:
  ColumnClip(const LatticeTriangle& t, int shift, const VoxelBox& window, int axis, Clipper* memory)
      : shift_(shift), axis_(axis), row_(&memory->rows_[0]), next_(&memory->rows_[1]) {
    const std::array<int, 3> order{(axis + 1) % 3, (axis + 2) % 3, axis};
    for (int i = 0; i < 3; ++i) {
      for (int a = 0; a < 3; ++a) p_[i][a] = t.v[i][order[a]];
    }
    const VoxelBox cells = touched_cells(box_of(t), shift, window);
    for (int a = 0; a < 3; ++a) {
      first_[a] = cells.min[order[a]];
      last_[a] = cells.max[order[a]] - 1;
    }
    for (int e = 0; e < 3; ++e) {
      edges_[e] = {p_[e], p_[(e + 1) % 3]};
      if (edges_[e].a[0] > edges_[e].b[0]) std::swap(edges_[e].a, edges_[e].b);
    }
  }

  void run(const Clipper::Sink& sink) {
    if (first_[0] > last_[0] || first_[1] > last_[1] || first_[2] > last_[2]) return;
    set_plane();
    clear(row_);
    clear(next_);
    Cut low = cut(first_[0]);
    add_line(first_[0], low, {row_, nullptr});
    for (int64_t k = first_[0]; k <= last_[0]; ++k) {
      const Cut high = cut(k + 1);
      add_slab(k, low, high);
      add_line(k + 1, high, {row_, next_});
      emit(k, sink);
      std::swap(row_, next_);
      low = high;
    }
  }

 private:
  using Coordinates = std::array<int64_t, 3>;  // u, v, w
  using Rows = std::array<Clipper::Row*, 2>;   // the second may be null
  struct Edge {
    Coordinates a, b;  // a.u <= b.u
  };
  // The crossings of the edges with a line u = k*S (an edge inside the line has none).
  struct Cut {
    std::array<bool, 3> crosses;
    std::array<Rounded, 3> v, w;
  };

  int64_t first_cell(int64_t ceil) const { return first_touched_cell(ceil, shift_); }
  int64_t last_cell(int64_t floor) const { return last_touched_cell(floor, shift_); }

  void set_plane() {
    Coordinates a, b;
    for (int i = 0; i < 3; ++i) {
      a[i] = p_[1][i] - p_[0][i];
      b[i] = p_[2][i] - p_[0][i];
    }
    nu_ = Int(a[1]) * b[2] - Int(a[2]) * b[1];
    nv_ = Int(a[2]) * b[0] - Int(a[0]) * b[2];
    nw_ = Int(a[0]) * b[1] - Int(a[1]) * b[0];
    if (nw_ < 0) {
      nu_ = -nu_;
      nv_ = -nv_;
      nw_ = -nw_;
    }
  }

  // Coordinate `to` of the point on edge e whose coordinate `at` is x.
  static Rounded cross(const Edge& e, int at, int64_t x, int to) {
    Int dividend = Int(e.b[to] - e.a[to]) * (x - e.a[at]);
    Int divisor = e.b[at] - e.a[at];
    if (divisor < 0) {
      dividend = -dividend;
      divisor = -divisor;
    }
    return Division<Int>(dividend, divisor).plus(e.a[to]);
  }

  Cut cut(int64_t k) const {
    const int64_t u = k << shift_;
    Cut cut{};
    for (int i = 0; i < 3; ++i) {
      const Edge& e = edges_[i];
      cut.crosses[i] = e.a[0] <= u && u <= e.b[0] && e.a[0] != e.b[0];
      if (!cut.crosses[i]) continue;
      cut.v[i] = cross(e, 0, u, 1);
      cut.w[i] = cross(e, 0, u, 2);
    }
    return cut;
  }

  void clear(Clipper::Row* row) {
    const size_t width = size_t(last_[1] - first_[1] + 1);
    if (row->columns.size() < width) row->columns.resize(width);
    row->first = kNone;
    row->last = -kNone;
  }

  // Adds a point with height w to column m.
  void add(Clipper::Row* row, int64_t m, const Rounded& w) {
    if (row == nullptr || m < first_[1] || m > last_[1]) return;
    // The touched range grows over columns that are uninitialized or hold an older slab.
    if (row->first > row->last) row->first = m, row->last = m - 1;
    while (m < row->first) reset(row, --row->first);
    while (m > row->last) reset(row, ++row->last);
    Clipper::Span& span = row->columns[size_t(m - first_[1])];
    span.lowest_ceil = std::min(span.lowest_ceil, w.ceil);
    span.highest_floor = std::max(span.highest_floor, w.floor);
  }
  void reset(Clipper::Row* row, int64_t m) {
    row->columns[size_t(m - first_[1])] = {kNone, -kNone};
  }
  void add_point(Clipper::Row* row, const Rounded& v, const Rounded& w) {
    for (int64_t m = first_cell(v.ceil); m <= last_cell(v.floor); ++m) add(row, m, w);
  }

  // Adds the corners on the line u = k*S: crossings with edges (2) and corners of squares (3).
  void add_line(int64_t k, const Cut& cut, const Rows& rows) {
    int64_t low = kNone, high = -kNone;
    for (int i = 0; i < 3; ++i) {
      if (!cut.crosses[i]) continue;
      for (Clipper::Row* row : rows) {
        if (row != nullptr) add_point(row, cut.v[i], cut.w[i]);
      }
      low = std::min(low, cut.v[i].ceil);
      high = std::max(high, cut.v[i].floor);
    }
    if (low > high || nw_ == 0) return;
    const int64_t begin = std::max(first_[1], first_cell(low) + 1);
    const int64_t end = std::min(last_[1] + 1, last_cell(high));
    if (begin <= end) walk_corners(k << shift_, begin, end, rows);
  }

  // Adds the plane's w at the corners (u, m*S), m = begin .. end: one division, then exact steps.
  void walk_corners(int64_t u, int64_t begin, int64_t end, const Rows& rows) {
    const Int start = nu_ * (u - p_[0][0]) + nv_ * ((begin << shift_) - p_[0][1]);
    Division<Int> at(-start, nw_);
    if (begin < end && !has_step_) {
      step_ = Division<Int>(-(nv_ * (int64_t(1) << shift_)), nw_);
      has_step_ = true;
    }
    for (int64_t m = begin;; ++m) {
      const Rounded w = at.plus(p_[0][2]);
      for (Clipper::Row* row : rows) {
        add(row, m - 1, w);
        add(row, m, w);
      }
      if (m == end) break;
      at.quotient += step_.quotient;
      at.remainder += step_.remainder;
      if (at.remainder >= nw_) {
        at.remainder -= nw_;
        at.quotient += 1;
      }
    }
  }

  // Adds the corners between the lines: vertices (1) and crossings with lines v = m*S (2).
  void add_slab(int64_t k, const Cut& low, const Cut& high) {
    const int64_t u0 = k << shift_, u1 = (k + 1) << shift_;
    for (const Coordinates& p : p_) {
      if (u0 <= p[0] && p[0] <= u1) add_point(row_, {p[1], p[1]}, {p[2], p[2]});
    }
    for (int i = 0; i < 3; ++i) {
      const Edge& e = edges_[i];
      if (e.b[0] < u0 || e.a[0] > u1 || e.a[1] == e.b[1]) continue;
      // The v of the edge's two ends inside the slab; between them v is monotone.
      const Rounded a = e.a[0] >= u0 ? Rounded{e.a[1], e.a[1]} : low.v[i];
      const Rounded b = e.b[0] <= u1 ? Rounded{e.b[1], e.b[1]} : high.v[i];
      const int64_t begin = std::max(first_[1], first_cell(std::min(a.ceil, b.ceil)) + 1);
      const int64_t end = std::min(last_[1] + 1, last_cell(std::max(a.floor, b.floor)));
      for (int64_t m = begin; m <= end; ++m) {
        const Rounded w = cross(e, 1, m << shift_, 2);
        add(row_, m - 1, w);
        add(row_, m, w);
      }
    }
  }

  // Passes the cells of slab k to the sink and empties its row.
  void emit(int64_t k, const Clipper::Sink& sink) {
    for (int64_t m = row_->first; m <= row_->last; ++m) {
      const Clipper::Span& span = row_->columns[size_t(m - first_[1])];
      const int64_t begin = std::max(first_[2], first_cell(span.lowest_ceil));
      const int64_t end = std::min(last_[2], last_cell(span.highest_floor));
      if (begin > end) continue;
      CellRun run{LatticePoint(0), axis_, end - begin + 1};
      run.first[(axis_ + 1) % 3] = k;
      run.first[(axis_ + 2) % 3] = m;
      run.first[axis_] = begin;
      sink(run);
    }
    row_->first = kNone;
    row_->last = -kNone;
  }

  int shift_;
  int axis_;
  Clipper::Row *row_, *next_;
  std::array<Coordinates, 3> p_;
  std::array<Edge, 3> edges_;
  Coordinates first_, last_;  // cells of the window that the triangle's box touches, inclusive
  Int nu_ = 0, nv_ = 0, nw_ = 0;
  Division<Int> step_{Int(0), Int(1)};
  bool has_step_ = false;
};

void Clipper::run(const LatticeTriangle& triangle, int shift, const VoxelBox& window,
                  const Sink& sink, int axis) {
  if (window.empty()) return;
  if (axis == kBestAxis) axis = best_axis(triangle);
  if (fits_int128(triangle)) {
    ColumnClip<Int128>(triangle, shift, window, axis, this).run(sink);
  } else {
    ColumnClip<Int256>(triangle, shift, window, axis, this).run(sink);
  }
}

}  // namespace svdag
