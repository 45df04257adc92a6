#include "verify/judge/centre_lines.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <limits>

namespace svdag {
namespace {

using Int256 = boost::multiprecision::int256_t;

// Intersects one triangle with the lines of centres of an axis. visit(voxel, up) is called for each
// line that crosses it, with the coordinate on the axis that is floor((height - offset) / S), and
// with the side that the normal points to.
template <class Int, class Visit>
class CentreLines {
 public:
  CentreLines(const LatticeTriangle& t, int shift, int64_t offset, const VoxelBox& window,
              const Visit& visit)
      : t_(t),
        shift_(shift),
        half_(int64_t(1) << shift >> 1),
        offset_(offset),
        window_(window),
        visit_(visit) {
    const LatticePoint a = t.v[1] - t.v[0], b = t.v[2] - t.v[0];
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      normal_[i] = Int(a[j]) * b[k] - Int(a[k]) * b[j];
    }
  }

  void run(int axis) {
    w_ = axis;
    if (normal_[w_] != 0) along_axis();
  }

 private:
  int64_t centre(int64_t k) const { return (k << shift_) + half_; }
  // The first k with centre(k) >= q.
  int64_t first_from(int64_t q) const { return -((half_ - q) >> shift_); }

  void along_axis() {
    u_ = w_ == 0 ? 1 : 0;
    v_ = w_ == 2 ? 1 : 2;
    const bool flip = normal_[w_] < 0;
    for (int a = 0; a < 3; ++a) n_[a] = flip ? Int(-normal_[a]) : normal_[a];
    int first = 0;
    while (n_[first] == 0) ++first;
    up_ = n_[first] < 0;
    step_ = Division<Int>(-(n_[u_] * (int64_t(1) << shift_)), n_[w_]);
    const auto [low, high] = std::minmax({t_.v[0][v_], t_.v[1][v_], t_.v[2][v_]});
    const int64_t end = std::min(window_.max[v_], first_from(high));
    for (int64_t m = std::max(window_.min[v_], first_from(low)); m < end; ++m) row(m);
  }

  void row(int64_t m) {
    const int64_t v = centre(m);
    int64_t left = std::numeric_limits<int64_t>::max(), right = -left;
    for (int i = 0; i < 3; ++i) {
      LatticePoint a = t_.v[i], b = t_.v[(i + 1) % 3];
      if (a[v_] > b[v_]) std::swap(a, b);
      if (!(a[v_] <= v && v < b[v_])) continue;
      const Division<Int> cut(Int(v - a[v_]) * (b[u_] - a[u_]), Int(b[v_] - a[v_]));
      const int64_t crossing = cut.plus(a[u_]).ceil;
      left = std::min(left, crossing);
      right = std::max(right, crossing);
    }
    if (left >= right) return;
    const int64_t begin = std::max(window_.min[u_], first_from(left));
    const int64_t end = std::min(window_.max[u_], first_from(right));
    if (begin < end) walk(m, begin, end);
  }

  // Computes the heights over the centres begin .. end-1 of row m: one division, then exact steps.
  void walk(int64_t m, int64_t begin, int64_t end) {
    const LatticePoint& p = t_.v[0];
    Division<Int> at(-(n_[u_] * (centre(begin) - p[u_]) + n_[v_] * (centre(m) - p[v_])), n_[w_]);
    for (int64_t j = begin; j < end; ++j) {
      const Rounded height = at.plus(p[w_] - offset_);
      int64_t k = height.floor >> shift_;
      const bool on_plane = height.floor == height.ceil && k << shift_ == height.floor;
      if (on_plane && !up_) --k;
      LatticePoint voxel;
      voxel[u_] = j;
      voxel[v_] = m;
      voxel[w_] = k;
      visit_(voxel, normal_[w_] > 0);
      at.quotient += step_.quotient;
      at.remainder += step_.remainder;
      if (at.remainder >= n_[w_]) {
        at.remainder -= n_[w_];
        at.quotient += 1;
      }
    }
  }

  const LatticeTriangle& t_;
  int shift_;
  int64_t half_;
  int64_t offset_;
  VoxelBox window_;
  const Visit& visit_;
  std::array<Int, 3> normal_, n_;  // n_: the normal or its opposite, with n_w > 0
  int u_ = 0, v_ = 0, w_ = 0;
  bool up_ = false;  // true if d moves a height on a voxel plane upwards
  Division<Int> step_{0, 1};
};

template <class Visit>
void visit_lines(const LatticeTriangle& triangle, int shift, int64_t offset, int axis,
                 const VoxelBox& window, const Visit& visit) {
  if (fits_int128(triangle)) {
    CentreLines<Int128, Visit>(triangle, shift, offset, window, visit).run(axis);
  } else {
    CentreLines<Int256, Visit>(triangle, shift, offset, window, visit).run(axis);
  }
}

}  // namespace

void thin_voxels(const LatticeTriangle& triangle, int shift, const VoxelBox& window,
                 const Clipper::Sink& sink) {
  if (window.empty()) return;
  for (int w = 0; w < 3; ++w) {
    visit_lines(triangle, shift, 0, w, window, [&](const LatticePoint& voxel, bool) {
      if (voxel[w] >= window.min[w] && voxel[w] < window.max[w]) sink({voxel, w, 1});
    });
  }
}

void winding_changes(const LatticeTriangle& triangle, int shift, const VoxelBox& window,
                     const WindingSink& sink) {
  if (window.empty() || triangle.sheet != 0) return;
  const int64_t half = int64_t(1) << shift >> 1;
  visit_lines(triangle, shift, half, 2, window, [&](LatticePoint voxel, bool up) {
    voxel.z = std::max(voxel.z + 1, window.min.z);  // the first centre above the crossing
    if (voxel.z < window.max.z) sink(voxel, up ? -1 : 1);
  });
}

}  // namespace svdag
