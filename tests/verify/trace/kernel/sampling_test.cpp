// Secondary rays are within their bounds, have the right density, and are reproducible.
#include "verify/trace/kernel/sampling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/verify/trace/ray_families.h"
#include "verify/trace/kernel/rays.h"
#include "verify/trace/kernel/workload.h"

namespace svdag {
namespace {

TEST(Sampling, EveryStratumOfTheSquareHasOnePoint) {
  for (const uint32_t count : {1U, 16U, 64U, 70U}) {
    const auto side = uint32_t(std::sqrt(count));
    std::vector<int> strata(side * side);
    for (uint32_t i = 0; i < count; ++i) {
      const Point2 p = square_point(77, i, count);
      ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
      if (i < side * side) ++strata[uint32_t(p.y * side) * side + uint32_t(p.x * side)];
    }
    for (const int n : strata) ASSERT_EQ(n, 1);
  }
}

TEST(Sampling, PixelsHaveDifferentPoints) {
  const Point2 a = square_point(1, 3, 64), b = square_point(2, 3, 64), c = square_point(1, 3, 64);
  EXPECT_NE(a.x, b.x);
  EXPECT_EQ(a.x, c.x);
  EXPECT_EQ(a.y, c.y);
}

TEST(Sampling, SineAndCosineMatchTheLibrary) {
  for (double v = -0.5; v <= 0.5; v += 1.0 / 4096) {
    const Point2 turn = quarter_turns(v);
    ASSERT_NEAR(turn.x, std::cos(v * 1.5707963267948966), 1e-8);
    ASSERT_NEAR(turn.y, std::sin(v * 1.5707963267948966), 1e-8);
  }
}

TEST(Sampling, TheDiskIsCoveredEvenly) {
  // Equal areas: rings between sqrt(i / 8) and quadrants.
  int cells[32] = {};
  constexpr uint32_t kCount = 1U << 18;
  for (uint32_t i = 0; i < kCount; ++i) {
    const Point2 p = disk_point(square_point(5, i, kCount));
    const double square = p.x * p.x + p.y * p.y;
    ASSERT_LE(square, 1 + 1e-7);
    ++cells[std::min(7, int(square * 8)) * 4 + (p.x < 0) * 2 + (p.y < 0)];
  }
  for (const int n : cells) EXPECT_NEAR(n, kCount / 32.0, kCount / 32.0 * 0.02);
}

TEST(Sampling, DirectionsAreAboveTheSurfaceWithCosineDensity) {
  for (const Vec3& n : {Vec3{{0, 0, 1}}, Vec3{{0, 0, -1}}, normalized({{1, -2, 3}})}) {
    Vec3 mean{};
    double square = 0;
    constexpr uint32_t kCount = 1U << 16;
    for (uint32_t i = 0; i < kCount; ++i) {
      const Vec3 d = cosine_direction(n, square_point(9, i, kCount));
      ASSERT_NEAR(length(d), 1, 1e-7);
      ASSERT_GE(dot(d, n), 0);
      mean = mean + d * (1.0 / kCount);
      square += dot(d, n) * dot(d, n) / kCount;
    }
    EXPECT_NEAR(dot(mean, n), 2.0 / 3, 1e-3);  // mean of the cosine
    EXPECT_NEAR(square, 1.0 / 2, 1e-3);
    EXPECT_NEAR(length(mean), 2.0 / 3, 1e-3);  // nothing sideways
  }
}

TEST(Sampling, SoftRaysEndOnTheLight) {
  const Light light{{{100, 50, -20}}, 7};
  const Surfel surfel{true, {{10, 20, 30}}, {{0, 1, 0}}};
  for (uint32_t i = 0; i < 64; ++i) {
    const Ray ray = soft_ray(surfel, light, 4, i, 64);
    const Vec3 off = ray.origin + ray.direction - light.centre;
    EXPECT_LE(length(off), 7 + 1e-6);
    EXPECT_NEAR(dot(off, normalized(light.centre - surfel.point)), 0, 1e-9);
  }
}

// A ray without a direction has no valid cell, and a tracer that resumes from it would give a wrong
// hit for the next ray.
TEST(Sampling, ALightAtTheSurfaceGivesValidRays) {
  const Surfel surfel{true, {{1, 2, 3}}, {{0, 0, 1}}};
  for (const double radius : {0.0, 2.0}) {
    for (const double off : {0.0, 1e-320, 1e-200, 1e-95}) {
      const Light light{{{1, 2, 3 + off}}, radius};
      for (uint32_t i = 0; i < 16; ++i) {
        for (const Ray& ray : {shadow_ray(surfel, light), soft_ray(surfel, light, 4, i, 16)}) {
          EXPECT_GT(length(ray.direction), 0);
          EXPECT_LE(length(ray.direction), radius + 1e-7);
        }
      }
    }
  }
}

// Rays traced in a batch give the same results as each ray alone.
TEST(Sampling, ALightAtTheSurfaceDoesNotAffectOtherRays) {
  const RawFile raw(raw_dag(test_grid(6), clustered_voxels(6, 3, 5)));
  const Surfel surfel{true, {{20, 30, 40}}, {{0, 0, 1}}};
  const Light lights[] = {{{{50, 60, 20}}, 9}, {surfel.point, 4}, {{{5, 3, 60}}, 9}};
  std::vector<Ray> rays;
  for (uint32_t i = 0; i < 48; ++i) rays.push_back(soft_ray(surfel, lights[i % 3], 7, i, 48));
  std::vector<uint8_t> together(rays.size());
  trace_any(raw.view(), {}, rays.data(), rays.size(), {0, 1}, {}, together.data());
  for (size_t i = 0; i < rays.size(); ++i) {
    uint8_t alone = 0;
    trace_any(raw.view(), {}, &rays[i], 1, {0, 1}, {}, &alone);
    EXPECT_EQ(together[i], alone) << i;
  }
}

}  // namespace
}  // namespace svdag
