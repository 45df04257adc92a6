// Embree's hits and distances against all triangles, by independent formulas.
#include "verify/trace/judge/embree.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "io/float_rounding.h"
#include "tests/expect_error.h"
#include "tests/verify/soup.h"

namespace svdag {
namespace {

#ifdef SVDAG_HAS_EMBREE

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct TracedSoup {
  TracedSoup(const Grid& grid, const std::vector<LatticeTriangle>& soup)
      : tracer(middle(grid), soup.size(), 2, &budget) {
    tracer.add(soup, grid.fraction());
    tracer.build();
  }
  static Vec3 middle(const Grid& grid) {
    const double half = double(grid.resolution() / 2);
    return {{half, half, half}};
  }

  MemoryBudget budget;
  TriangleTracer tracer;
};

// Moeller and Trumbore 1997. Lowers `margin` to how close the decision is to a tie.
std::optional<double> hit_of(const Ray& ray, const VoxelTriangle& t, double* margin) {
  const Vec3 a = t.v[1] - t.v[0], b = t.v[2] - t.v[0], p = cross(ray.direction, b);
  const double det = dot(a, p);
  if (det == 0) return {};
  const Vec3 s = ray.origin - t.v[0], q = cross(s, a);
  const double u = dot(s, p) / det, v = dot(ray.direction, q) / det, w = 1 - u - v;
  const double min = std::min({u, v, w});
  const double at = dot(b, q) / det;
  if (at > 0) *margin = std::min(*margin, std::abs(min));
  if (min < 0 || at < 0) return {};
  return at;
}

// The point of the triangle nearest to p, by the regions of Ericson 2005, section 5.1.5.
double distance_of(const Vec3& p, const VoxelTriangle& t) {
  const Vec3 &a = t.v[0], &b = t.v[1], &c = t.v[2];
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp);
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return length(ap);
  if (d3 >= 0 && d4 <= d3) return length(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return length(ap - ab * (d1 / (d1 - d3)));
  if (d6 >= 0 && d5 <= d6) return length(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return length(ap - ac * (d2 / (d2 - d6)));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return length(bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
  const double sum = va + vb + vc;
  return length(ap - ab * (vb / sum) - ac * (vc / sum));
}

class Numbers {
 public:
  explicit Numbers(uint64_t seed) : random_(seed) {}
  double unit() { return double(random_() >> 11) * 0x1p-53; }
  Vec3 point(double low, double high) {
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = low + unit() * (high - low);
    return p;
  }

 private:
  std::mt19937_64 random_;
};

TEST(Embree, FindsTheSameFirstHitAsBruteForce) {
  for (const int levels : {4, 8, 14, 20}) {
    const Grid grid = test_grid(levels);
    const double n = double(grid.resolution());
    const auto soup = random_soup(grid, 100, uint64_t(levels), grid.resolution() / 4);
    const TracedSoup traced(grid, soup);
    Numbers numbers(uint64_t(levels) + 1);
    int hits = 0, tested = 0;
    for (int i = 0; i < 2000; ++i) {
      // Half of the rays are aimed at the inside of a triangle.
      const VoxelTriangle& aim = traced.tracer.triangles()[size_t(i) % soup.size()];
      const Vec3 centre = (aim.v[0] + aim.v[1] + aim.v[2]) * (1.0 / 3);
      const Vec3 from = numbers.point(-n, 2 * n), to = i % 2 ? centre : numbers.point(0, n);
      const Ray ray = float_ray({from, to - from}, traced.tracer.middle());
      double margin = kInfinite;
      std::optional<double> first;
      for (const VoxelTriangle& t : traced.tracer.triangles()) {
        const auto at = hit_of(ray, t, &margin);
        if (at && (!first || *at < *first)) first = at;
      }
      if (margin < 1e-4) continue;  // floats may miss near an edge
      ++tested;
      const auto hit = traced.tracer.closest(ray, 0, kInfinite);
      ASSERT_EQ(hit.has_value(), first.has_value()) << levels << ", ray " << i;
      if (!hit) continue;
      ++hits;
      EXPECT_NEAR(hit->t, *first, 1e-9 * n) << levels << ", ray " << i;
      EXPECT_FALSE(hit->doubtful);
    }
    EXPECT_GT(hits, 200) << levels;
    EXPECT_GT(tested, 1000) << levels;
  }
}

TEST(Embree, HitsOutsideTheSpanAreIgnored) {
  const Grid grid = test_grid(5);
  const int64_t s = int64_t(1) << grid.fraction();
  const LatticeTriangle wall{{{LatticePoint(10 * s, 0, 0), LatticePoint(10 * s, 64 * s, 0),
                               LatticePoint(10 * s, 0, 64 * s)}}};
  const TracedSoup traced(grid, {wall});
  const Ray ray{{{2, 5, 5}}, {{1, 0, 0}}};
  EXPECT_EQ(traced.tracer.closest(ray, 0, 20)->t, 8);
  EXPECT_EQ(traced.tracer.closest(ray, 8, 8)->t, 8);
  EXPECT_FALSE(traced.tracer.closest(ray, 0, 7.999999));
  EXPECT_FALSE(traced.tracer.closest(ray, 8.000001, 20));
}

TEST(Embree, HitOnAnEdgeIsDoubtful) {
  const Grid grid = test_grid(5);
  const int64_t s = int64_t(1) << grid.fraction();
  const LatticeTriangle wall{
      {{LatticePoint(10 * s, 2 * s, 2 * s), LatticePoint(10 * s, 8 * s, 2 * s),
        LatticePoint(10 * s, 2 * s, 8 * s)}}};
  const TracedSoup traced(grid, {wall});
  const auto on = traced.tracer.closest({{{2, 4, 2}}, {{1, 0, 0}}}, 0, 20);
  ASSERT_TRUE(on);
  EXPECT_TRUE(on->doubtful);
  const auto in = traced.tracer.closest({{{2, 4, 2 + 0x1p-20}}, {{1, 0, 0}}}, 0, 20);
  ASSERT_TRUE(in);
  EXPECT_FALSE(in->doubtful);
}

TEST(Embree, DistanceIsTheMinimumOfAll) {
  for (const int levels : {4, 8, 14, 20}) {
    const Grid grid = test_grid(levels);
    const double n = double(grid.resolution());
    const auto soup = random_soup(grid, 100, uint64_t(levels), grid.resolution() / 4);
    const TracedSoup traced(grid, soup);
    Numbers numbers(uint64_t(levels) + 2);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 point = numbers.point(-0.5 * n, 1.5 * n);
      double min = kInfinite;
      for (const VoxelTriangle& t : traced.tracer.triangles())
        min = std::min(min, distance_of(point, t));
      EXPECT_NEAR(traced.tracer.distance_to(point, kInfinite), min, 1e-9 * n);
      EXPECT_NEAR(traced.tracer.distance_to(point, min + 1e-6 * n), min, 1e-9 * n);
      EXPECT_EQ(traced.tracer.distance_to(point, min * (1 - 1e-6)), kInfinite);
    }
  }
}

TEST(Embree, DistancesToTrianglesWithoutAreaAreExact) {
  const Grid grid = test_grid(6);
  const int64_t s = int64_t(1) << grid.fraction();
  const LatticePoint a(10 * s, 20 * s, 30 * s), b(20 * s, 20 * s, 30 * s);
  const TracedSoup point(grid, {{{a, a, a}}}), segment(grid, {{{a, b, b}}}),
      folded(grid, {{{a, b, LatticePoint(15 * s, 20 * s, 30 * s)}}});
  EXPECT_EQ(point.tracer.distance_to({{10, 23, 34}}, kInfinite), 5);
  for (const TracedSoup* traced : {&segment, &folded}) {
    EXPECT_EQ(traced->tracer.distance_to({{13, 23, 34}}, kInfinite), 5);
    EXPECT_EQ(traced->tracer.distance_to({{25, 20, 30}}, kInfinite), 5);
    EXPECT_FALSE(traced->tracer.closest({{{13, 0, 30}}, {{0, 1, 0}}}, 0, 100));
  }
}

TEST(Embree, RejectsMoreTrianglesThanItCanNumber) {
  MemoryBudget budget;
  EXPECT_SVDAG_ERROR(TriangleTracer({}, (uint64_t(1) << 32) / 3 + 1, 1, &budget), ExitCode::kUsage,
                     "cannot number");
}

TEST(Embree, ObeysTheBudget) {
  const Grid grid = test_grid(10);
  const auto soup = random_soup(grid, 100'000, 1, 10);
  MemoryBudget none(1'000'000);
  EXPECT_SVDAG_ERROR(TriangleTracer({}, soup.size(), 1, &none), ExitCode::kMemory,
                     "triangles for Embree");
  MemoryBudget some(13'000'000);  // the triangles fit, the tree does not
  TriangleTracer tracer({}, soup.size(), 1, &some);
  tracer.add(soup, grid.fraction());
  EXPECT_SVDAG_ERROR(tracer.build(), ExitCode::kMemory, "nodes of Embree");
}

#else

TEST(Embree, IsAnErrorInBuildsWithoutIt) {
  MemoryBudget budget;
  EXPECT_SVDAG_ERROR(TriangleTracer({}, 1, 1, &budget), ExitCode::kUsage, "without Embree");
}

#endif

TEST(FloatRay, IsRoundedToFloats) {
  const Vec3 middle{{32768, 32768, 32768}};
  const Ray ray = float_ray({{{1.1, 2.2, 65000.3}}, {{3, 4, -12}}}, middle);
  for (int a = 0; a < 3; ++a) {
    const double from = ray.origin[a] - middle[a];
    EXPECT_EQ(from, round_to_float(from));
    EXPECT_EQ(ray.direction[a], round_to_float(ray.direction[a]));
  }
  EXPECT_NEAR(ray.origin[0], 1.1, 0x1p-9);
  EXPECT_NEAR(ray.direction[0], 3.0 / 13, 0x1p-24);
  EXPECT_NEAR(length(ray.direction), 1, 0x1p-22);
}

}  // namespace
}  // namespace svdag
