// The fast traversal, beams and batches give the hits of the plain traversal, bit by bit.
#include <gtest/gtest.h>

#include "tests/verify/trace/plain_traversal.h"
#include "tests/verify/trace/ray_families.h"
#include "verify/trace/kernel/beam.h"
#include "verify/trace/kernel/rays.h"
#include "verify/trace/kernel/workload.h"

namespace svdag {
namespace {

::testing::AssertionResult same_hits(const Hit& a, const Hit& b, const Ray& ray) {
  if (same(a, b)) return ::testing::AssertionSuccess();
  auto text = ::testing::AssertionFailure();
  for (const Hit& h : {a, b})
    text << (h.found ? "hit " : "miss ") << h.t << " at " << h.voxel[0] << " " << h.voxel[1] << " "
         << h.voxel[2] << " level " << h.level << " axis " << h.axis << "; ";
  text.operator<<(std::hexfloat);
  for (int a_ = 0; a_ < 3; ++a_) text << ray.origin[a_] << " + t * " << ray.direction[a_] << ", ";
  return text;
}

class SameHit : public ::testing::TestWithParam<int> {};

TEST_P(SameHit, TheFastTraversalGivesThePlainHits) {
  const int levels = GetParam();
  const VoxelSet voxels = clustered_voxels(levels, uint64_t(levels), 12);
  const RawFile file(raw_dag(test_grid(levels), voxels));
  const DagView dag = file.view();
  RayFamilies rays(uint64_t(7 * levels), double(dag.resolution()));
  Tracer tracer(dag);  // one for all, so that rays resume on paths of others
  std::vector<VoxelSet::value_type> list(voxels.begin(), voxels.end());
  for (int family = 0; family < kRayFamilies; ++family) {
    int hits = 0;
    const int count = rays_per_family();
    for (int i = 0; i < count; ++i) {
      const auto& [x, y, z] = list[size_t(rays.unit() * double(list.size()))];
      const Ray ray = rays.ray(
          family, {{double(x) + rays.unit(), double(y) + rays.unit(), double(z) + rays.unit()}});
      const Span span = rays.span();
      const Cut cut = rays.cut(dag.levels);
      const Hit plain = plain_closest(dag, ray, span, cut);
      ASSERT_TRUE(same_hits(tracer.closest(ray, span, cut), plain, ray)) << "family " << family;
      ASSERT_TRUE(same_hits(trace_closest(dag, ray, span, cut), plain, ray)) << "family " << family;
      ASSERT_EQ(trace_any(dag, ray, span, cut), plain.found);
      hits += plain.found;
    }
    EXPECT_GT(hits, count / 100) << "family " << family;
  }
}

TEST_P(SameHit, BatchesGiveTheHitsOfSingleRays) {
  const int levels = GetParam();
  const RawFile file(raw_dag(test_grid(levels), clustered_voxels(levels, 5, 30)));
  const DagView dag = file.view();
  RayFamilies families(3, double(dag.resolution()));
  std::vector<Ray> rays;
  for (int i = 0; i < 3000; ++i) {
    const double n = double(dag.resolution());
    rays.push_back(families.ray(i % kRayFamilies,
                                {{families.unit() * n, families.unit() * n, families.unit() * n}}));
  }
  std::vector<Hit> hits(rays.size());
  std::vector<uint8_t> found(rays.size(), 9);
  for (const Span& span : {Span{}, Span{0.1, 0.9}}) {
    trace_closest(dag, rays.data(), rays.size(), span, {}, hits.data());
    trace_any(dag, rays.data(), rays.size(), span, {}, found.data());
    for (size_t i = 0; i < rays.size(); ++i) {
      ASSERT_TRUE(same_hits(hits[i], plain_closest(dag, rays[i], span), rays[i]));
      ASSERT_EQ(found[i], hits[i].found);
    }
  }
}

TEST_P(SameHit, BeamsKeepAllHits) {
  const int levels = GetParam();
  const VoxelSet voxels = clustered_voxels(levels, 11, 20);
  const RawFile file(raw_dag(test_grid(levels), voxels));
  const DagView dag = file.view();
  RayFamilies families(uint64_t(levels), double(dag.resolution()));
  std::vector<VoxelSet::value_type> list(voxels.begin(), voxels.end());
  int hits = 0, later = 0;
  for (int i = 0; i < rays_per_family() / 8; ++i) {
    const auto& [x, y, z] = list[size_t(families.unit() * double(list.size()))];
    const Vec3 near{{double(x), double(y), double(z)}};
    const Ray middle = families.ray(i % kRayFamilies, near);
    const double width = std::ldexp(1, -int(families.unit() * 20));
    const bool both = i % 2;
    const Span span = families.span();
    const Cut cut = families.cut(dag.levels);
    std::vector<Ray> rays(16, middle);
    Beam beam;
    for (Ray& ray : rays) {
      const double size = length(middle.direction);
      for (int a = 0; a < 3; ++a) {
        ray.direction[a] += (families.unit() - 0.5) * width * size;
        if (both) ray.origin[a] += 30 * width * (families.unit() - 0.5);
      }
      beam.add(ray);
    }
    const Span reach = beam.reach(dag, span, cut, both);
    later += reach.begin > span.begin;
    for (const Ray& ray : rays) {
      const Hit expected = plain_closest(dag, ray, span, cut);
      ASSERT_TRUE(same_hits(trace_closest(dag, ray, reach, cut), expected, ray)) << "beam " << i;
      hits += expected.found;
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(later, 10);
}

INSTANTIATE_TEST_SUITE_P(Levels, SameHit, ::testing::Values(3, 4, 6, 9, 14, 20));

TEST(Beam, TilesOfAPictureStartLaterWithTheSameHits) {
  const RawFile file(raw_dag(test_grid(9), clustered_voxels(9, 2, 400)));
  const DagView dag = file.view();
  const Picture picture{look_at({{-300, 200, -350}}, {{256, 256, 256}}, 1, 50, 1.25), 80, 64};
  double begins = 0;
  int hits = 0;
  for (uint32_t y = 0; y < picture.height; y += kTile) {
    for (uint32_t x = 0; x < picture.width; x += kTile) {
      const Span span = tile_span(dag, picture, x, y);
      begins += span.begin < 1e300 ? span.begin : 0;
      for (uint32_t i = 0; i < kTile * kTile; ++i) {
        const Ray ray = picture.ray(x + i % kTile, y + i / kTile);
        const Hit expected = plain_closest(dag, ray);
        ASSERT_TRUE(same_hits(trace_closest(dag, ray, span), expected, ray));
        hits += expected.found;
      }
    }
  }
  EXPECT_GT(hits, 50);
  EXPECT_GT(begins, 1000);
}

}  // namespace
}  // namespace svdag
