#include "tests/bench/peers/cgal.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <variant>

#include "tests/bench/peers/frame.h"

namespace svdag::bench {
namespace {

template <class Kernel>
class CgalTest {
 public:
  using Point3 = typename Kernel::Point_3;
  using Segment = typename Kernel::Segment_3;
  using Setup = std::variant<typename Kernel::Triangle_3, Segment, Point3>;

  explicit CgalTest(const Grid& grid) : frame_(grid) {}

  Setup setup(const Triangle& t) const {
    const Point3 p[3] = {point(t.v[0]), point(t.v[1]), point(t.v[2])};
    if (!CGAL::collinear(p[0], p[1], p[2])) return typename Kernel::Triangle_3(p[0], p[1], p[2]);
    Point3 low = p[0], high = p[0];
    for (const Point3& q : p) {
      if (CGAL::compare_xyz(q, low) == CGAL::SMALLER) low = q;
      if (CGAL::compare_xyz(q, high) == CGAL::LARGER) high = q;
    }
    if (low == high) return low;
    return Segment(low, high);
  }

  bool operator()(const Setup& s, const LatticePoint& corner, int64_t side) const {
    const CGAL::Bbox_3 box(double(corner.x), double(corner.y), double(corner.z),
                           double(corner.x + side), double(corner.y + side),
                           double(corner.z + side));
    if (const Point3* p = std::get_if<Point3>(&s)) {
      const typename Kernel::Iso_cuboid_3 cuboid(box);
      return !cuboid.has_on_unbounded_side(*p);
    }
    if (const Segment* segment = std::get_if<Segment>(&s)) return CGAL::do_intersect(*segment, box);
    return CGAL::do_intersect(std::get<typename Kernel::Triangle_3>(s), box);
  }

 private:
  Point3 point(const Point& p) const {
    const RealPoint<double> r = frame_.in_voxels(p);
    return Point3(r[0], r[1], r[2]);
  }

  Frame<double> frame_;
};

template <class Kernel>
void run(const Grid& grid, std::span<const Triangle> triangles, const LatticePoint& corner,
         int log2, BrickList* out) {
  const CgalTest<Kernel> test(grid);
  std::vector<typename CgalTest<Kernel>::Setup> setups;
  setups.reserve(triangles.size());
  for (const Triangle& t : triangles) setups.push_back(test.setup(t));
  CubeDescent<CgalTest<Kernel>>(test, setups).run(corner, log2, out);
}

}  // namespace

void cgal_epick(const Grid& grid, std::span<const Triangle> triangles, const LatticePoint& corner,
                int log2, BrickList* out) {
  run<CGAL::Exact_predicates_inexact_constructions_kernel>(grid, triangles, corner, log2, out);
}

void cgal_epeck(const Grid& grid, std::span<const Triangle> triangles, const LatticePoint& corner,
                int log2, BrickList* out) {
  run<CGAL::Exact_predicates_exact_constructions_kernel>(grid, triangles, corner, log2, out);
}

}  // namespace svdag::bench
