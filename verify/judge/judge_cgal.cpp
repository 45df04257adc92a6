#include "verify/judge/judge_cgal.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <algorithm>
#include <variant>

#include "verify/judge/judge_cells.h"

namespace svdag {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Shape = std::variant<Kernel::Point_3, Kernel::Segment_3, Kernel::Triangle_3>;

// A double holds 53 bits; two doubles hold every lattice coordinate.
Number number(int64_t q) {
  constexpr int64_t kDouble = int64_t(1) << 53;
  if (-kDouble <= q && q <= kDouble) return Number(double(q));
  return Number(double(q >> 32)) * Number(0x1p32) + Number(double(q & 0xffffffff));
}

Kernel::Point_3 point(const LatticePoint& p) {
  return {number(p.x), number(p.y), number(p.z)};
}

// The triangle, or the segment or point to which it degenerates: on a line, the ends are the
// lexicographically smallest and largest vertex.
Shape shape_of(const LatticeTriangle& t) {
  std::array<Kernel::Point_3, 3> p{point(t.v[0]), point(t.v[1]), point(t.v[2])};
  if (!CGAL::collinear(p[0], p[1], p[2])) return Kernel::Triangle_3(p[0], p[1], p[2]);
  std::sort(p.begin(), p.end(), [](const Kernel::Point_3& a, const Kernel::Point_3& b) {
    return CGAL::lexicographically_xyz_smaller(a, b);
  });
  if (p[0] == p[2]) return p[0];
  return Kernel::Segment_3(p[0], p[2]);
}

bool meets(const Kernel::Point_3& shape, const Kernel::Iso_cuboid_3& box) {
  return !box.has_on_unbounded_side(shape);
}
template <class Other>
bool meets(const Other& shape, const Kernel::Iso_cuboid_3& box) {
  return CGAL::do_intersect(shape, box);
}

class CgalJudge final : public Judge {
 public:
  explicit CgalJudge(Rule rule) : rule_(rule) {}

  void cells(const LatticeTriangle& triangle, int shift, const VoxelBox& window,
             const Sink& sink) override {
    set_triangle(triangle);
    const VoxelBox box = touched_cells(box_of(triangle), shift, window);
    if (!box.empty()) descend(box, shift, sink);
  }

  void voxels(const LatticeTriangle& triangle, int fraction, const VoxelBox& window,
              const Sink& sink) override {
    if (rule_ != Rule::kThin) return cells(triangle, fraction, window, sink);
    // A shifted centre segment is in its closed voxel except for d. As e tends to 0 the crossing
    // persists, so a triangle that crosses it meets the closed voxel.
    cells(triangle, fraction, window, [&](const CellRun& voxel) {
      if (crosses_a_centre_segment(voxel.first, fraction)) sink(voxel);
    });
  }

  void windings(const LatticeTriangle& triangle, int fraction, const VoxelBox& window,
                const WindingSink& sink) override {
    set_triangle(triangle);
    const auto* shape = std::get_if<Kernel::Triangle_3>(&shape_);
    if (shape == nullptr || triangle.sheet != 0) return;
    const Kernel::Plane_3 plane = shape->supporting_plane();
    if (CGAL::is_zero(plane.c())) return;
    const bool up = CGAL::is_positive(plane.c());
    const LatticeBox box = box_of(triangle);
    LatticePoint voxel;
    for (voxel.x = std::max(window.min.x, box.min.x >> fraction);
         voxel.x < window.max.x && voxel.x <= box.max.x >> fraction; ++voxel.x) {
      for (voxel.y = std::max(window.min.y, box.min.y >> fraction);
           voxel.y < window.max.y && voxel.y <= box.max.y >> fraction; ++voxel.y) {
        std::array<Number, 3> low = shifted_centre(voxel, fraction), high = low;
        low[2] = number(box.min.z - 1);
        high[2] = number(box.max.z + 1);
        if (!CGAL::do_intersect(
                Kernel::Segment_3({low[0], low[1], low[2]}, {high[0], high[1], high[2]}), *shape))
          continue;
        // The first centre above the plane, by bisection.
        int64_t below = window.min.z - 1, above = window.max.z;
        while (above - below > 1) {
          voxel.z = (below + above) / 2;
          const auto centre = shifted_centre(voxel, fraction);
          const bool front = plane.has_on_positive_side({centre[0], centre[1], centre[2]});
          (front == up ? above : below) = voxel.z;
        }
        voxel.z = above;
        if (voxel.z < window.max.z) sink(voxel, up ? -1 : 1);
      }
    }
  }

 private:
  static std::array<Number, 3> shifted_centre(const LatticePoint& voxel, int shift) {
    constexpr double kShift[3] = {0x1p-256, 0x1p-512, 0x1p-768};
    const Number half(double(int64_t(1) << shift >> 1));
    std::array<Number, 3> centre;
    for (int a = 0; a < 3; ++a)
      centre[size_t(a)] = number(voxel[a] << shift) + half + Number(kShift[a]);
    return centre;
  }

  // The same triangle is tested many times: CGAL caches its exact numbers.
  void set_triangle(const LatticeTriangle& triangle) {
    if (triangle_ == triangle && has_triangle_) return;
    triangle_ = triangle;
    shape_ = shape_of(triangle);
    has_triangle_ = true;
  }

  void descend(const VoxelBox& box, int shift, const Sink& sink) {
    const Kernel::Iso_cuboid_3 cube(point(box.min << int64_t(shift)),
                                    point(box.max << int64_t(shift)));
    if (!std::visit([&](const auto& shape) { return meets(shape, cube); }, shape_)) return;
    const LatticePoint side = box.max - box.min;
    const int axis = side.x >= side.y ? (side.x >= side.z ? 0 : 2) : (side.y >= side.z ? 1 : 2);
    if (side[axis] == 1) return sink({box.min, axis, 1});
    VoxelBox lower = box, upper = box;
    lower.max[axis] = upper.min[axis] = box.min[axis] + side[axis] / 2;
    descend(lower, shift, sink);
    descend(upper, shift, sink);
  }

  bool crosses_a_centre_segment(const LatticePoint& voxel, int shift) const {
    const auto* triangle = std::get_if<Kernel::Triangle_3>(&shape_);
    if (triangle == nullptr) return false;
    const Number half(double(int64_t(1) << shift >> 1));
    const std::array<Number, 3> centre = shifted_centre(voxel, shift);
    for (size_t w = 0; w < 3; ++w) {
      std::array<Number, 3> from = centre, to = centre;
      from[w] -= half;
      to[w] += half;
      const Kernel::Segment_3 segment({from[0], from[1], from[2]}, {to[0], to[1], to[2]});
      if (CGAL::do_intersect(segment, *triangle)) return true;
    }
    return false;
  }

  Rule rule_;
  bool has_triangle_ = false;
  LatticeTriangle triangle_{};
  Shape shape_;
};

}  // namespace

std::unique_ptr<Judge> make_cgal_judge(Rule rule) {
  return std::make_unique<CgalJudge>(rule);
}

}  // namespace svdag
