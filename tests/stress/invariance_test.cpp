// Exact invariances of the voxels of a soup, tested on soups of every family.
//
// Permuting and mirroring axes changes the ties of the thin rule (its targets are shifted along x
// before y before z), so these are tested for the conservative rule only; all others for both.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "tests/any_of.h"
#include "tests/stress/compare_windows.h"
#include "tests/stress/world.h"

namespace svdag {
namespace {

constexpr Rule kRules[2] = {Rule::kConservative, Rule::kThin};

// A soup on the unit grid and a region of 32^3 voxels that keeps 40 voxels away from the border.
struct Sample {
  Spot spot;
  Soup soup;
  StressRandom random;
};

// RapidCheck draws the seed (and reports it). Triangles of families with other grids are already
// snapped, so they can be used on the unit grid.
Sample draw_sample() {
  static const std::vector<Family> families = [] {
    std::vector<Family> all;
    for (const auto& group :
         {shape_families(), plane_families(), contact_families(), format_families()})
      all.insert(all.end(), group.begin(), group.end());
    return all;
  }();
  const auto family = *any_of<size_t>(0, families.size());
  const int levels = *rc::gen::element(10, 13, 16, 20);
  Sample sample{{}, {}, StressRandom(*rc::gen::arbitrary<uint64_t>())};
  sample.spot = draw_spot(unit_grid(levels), 0, 32, SpotArea::kAnywhere, &sample.random);
  for (int a = 0; a < 3; ++a) {
    VoxelBox& region = sample.spot.region;
    region.min[a] = std::clamp<int64_t>(region.min[a], 40, sample.spot.grid.resolution() - 72);
    region.max[a] = region.min[a] + 32;
  }
  sample.soup = families[family].draw(sample.spot, &sample.random);
  return sample;
}

// Expects that `map` maps the voxels of `region` to those of `other`.
template <class Map>
void expect_mapped(const VoxelRegion& region, const VoxelRegion& other, const Map& map) {
  RC_ASSERT(region.count() == other.count());
  const VoxelBox& box = region.box();
  LatticePoint p;
  for (p.x = box.min.x; p.x < box.max.x; ++p.x) {
    for (p.y = box.min.y; p.y < box.max.y; ++p.y) {
      for (p.z = box.min.z; p.z < box.max.z; ++p.z) RC_ASSERT(region.test(p) == other.test(map(p)));
    }
  }
}

template <class Move>
Soup moved(Soup soup, const Move& move) {
  for (LatticeTriangle& t : soup) {
    for (LatticePoint& p : t.v) p = move(p);
  }
  return soup;
}

void expect_unchanged(const Sample& sample, const Soup& changed) {
  for (const Rule rule : kRules)
    RC_ASSERT(voxelized(sample.spot, {.rule = rule}, changed) ==
              voxelized(sample.spot, {.rule = rule}, sample.soup));
}

RC_GTEST_PROP(Invariance, TranslationByWholeVoxels, ()) {
  Sample sample = draw_sample();
  const LatticePoint by = sample.random.point(40);
  Spot there = sample.spot;
  there.region.min += by;
  there.region.max += by;
  const Soup soup =
      moved(sample.soup, [&](const LatticePoint& p) { return p + by * sample.spot.voxel(); });
  for (const Rule rule : kRules) {
    expect_mapped(voxelized(sample.spot, {.rule = rule}, sample.soup),
                  voxelized(there, {.rule = rule}, soup),
                  [&](const LatticePoint& p) { return p + by; });
  }
}

RC_GTEST_PROP(Invariance, PermutationOfTheAxes, ()) {
  Sample sample = draw_sample();
  std::array<int, 3> axes{0, 1, 2};
  for (int a = 2; a > 0; --a)
    std::swap(axes[size_t(a)], axes[sample.random.below(uint64_t(a) + 1)]);
  const auto permute = [&](const LatticePoint& p) {
    return LatticePoint(p[axes[0]], p[axes[1]], p[axes[2]]);
  };
  Spot there = sample.spot;
  there.region = {permute(sample.spot.region.min), permute(sample.spot.region.max)};
  expect_mapped(voxelized(sample.spot, {}, sample.soup),
                voxelized(there, {}, moved(sample.soup, permute)), permute);
}

RC_GTEST_PROP(Invariance, MirroringOfTheGrid, ()) {
  Sample sample = draw_sample();
  const int w = sample.random.axis();
  const int64_t n = sample.spot.grid.resolution();
  const auto mirror = [w](LatticePoint p, int64_t sum) {
    p[w] = sum - p[w];
    return p;
  };
  Spot there = sample.spot;
  there.region.min[w] = n - sample.spot.region.max[w];
  there.region.max[w] = n - sample.spot.region.min[w];
  const Soup soup = moved(sample.soup, [&](const LatticePoint& p) {
    return mirror(p, n << sample.spot.grid.fraction());
  });
  expect_mapped(voxelized(sample.spot, {}, sample.soup), voxelized(there, {}, soup),
                [&](const LatticePoint& p) { return mirror(p, n - 1); });
}

RC_GTEST_PROP(Invariance, WindingAndFirstVertex, ()) {
  Sample sample = draw_sample();
  Soup soup = sample.soup;
  for (LatticeTriangle& t : soup) {
    std::rotate(t.v.begin(), t.v.begin() + sample.random.axis(), t.v.end());
    if (sample.random.coin()) std::swap(t.v[0], t.v[1]);
  }
  expect_unchanged(sample, soup);
}

RC_GTEST_PROP(Invariance, OrderAndDuplicates, ()) {
  Sample sample = draw_sample();
  Soup soup = sample.soup;
  soup.insert(soup.end(), sample.soup.begin(), sample.soup.end());
  for (size_t i = soup.size() - 1; i > 0; --i) std::swap(soup[i], soup[sample.random.below(i + 1)]);
  expect_unchanged(sample, soup);
}

// Each triangle in four, at the midpoints of its edges; even coordinates have midpoints on the
// lattice.
Soup subdivided(const Soup& soup) {
  Soup parts;
  for (const LatticeTriangle& t : soup) {
    LatticePoint m[3];  // of the edge opposite to vertex i
    for (int i = 0; i < 3; ++i) m[i] = (t.v[(i + 1) % 3] + t.v[(i + 2) % 3]) / int64_t(2);
    for (int i = 0; i < 3; ++i) parts.push_back({{t.v[i], m[(i + 2) % 3], m[(i + 1) % 3]}});
    parts.push_back({{m[0], m[1], m[2]}});
  }
  return parts;
}

LatticePoint even(const LatticePoint& p) {
  return {p.x & ~int64_t(1), p.y & ~int64_t(1), p.z & ~int64_t(1)};
}

RC_GTEST_PROP(Invariance, SubdivisionAtLatticeMidpoints, ()) {
  Sample sample = draw_sample();
  sample.soup = moved(sample.soup, even);
  expect_unchanged(sample, subdivided(sample.soup));
}

// With scene and grid scaled by the same power of two, the snap gives the same lattice triangles.
RC_GTEST_PROP(Invariance, ScalingByPowersOfTwo, ()) {
  Sample sample = draw_sample();
  const Grid& grid = sample.spot.grid;
  const int power = *any_of(-900, 900);
  std::vector<Triangle> world, scaled;
  for (const LatticeTriangle& t : sample.soup) {
    Triangle a, b;
    for (int i = 0; i < 3; ++i) {
      a.v[size_t(i)] = to_world(grid, Point(t.v[size_t(i)]) / double(sample.spot.voxel()));
      for (int k = 0; k < 3; ++k) b.v[size_t(i)][k] = std::ldexp(a.v[size_t(i)][k], power);
    }
    world.push_back(a);
    scaled.push_back(b);
  }
  Grid other = grid;
  other.voxel_size = std::ldexp(grid.voxel_size, power);
  const Soup here = snapped(grid, world);
  RC_ASSERT(here == snapped(other, scaled));
  expect_unchanged({sample.spot, here, sample.random}, snapped(other, scaled));
}

// The triangles of a sample closed up to solids.
Sample draw_solid() {
  Sample sample = draw_sample();
  sample.soup = moved(closed_up(sample.soup, sample.spot.anchor(&sample.random)), even);
  return sample;
}

void expect_same_solid(const Sample& sample, Rule rule, const Soup& changed) {
  RC_ASSERT(voxelized(sample.spot, {.rule = rule}, changed) ==
            voxelized(sample.spot, {.rule = rule}, sample.soup));
}

RC_GTEST_PROP(InvarianceOfSolids, TranslationByWholeVoxels, ()) {
  Sample sample = draw_solid();
  const LatticePoint by = sample.random.point(40);
  Spot there = sample.spot;
  there.region.min += by;
  there.region.max += by;
  const Soup soup =
      moved(sample.soup, [&](const LatticePoint& p) { return p + by * sample.spot.voxel(); });
  for (const Rule rule : {Rule::kSolid, Rule::kSolidOdd}) {
    expect_mapped(voxelized(sample.spot, {.rule = rule}, sample.soup),
                  voxelized(there, {.rule = rule}, soup),
                  [&](const LatticePoint& p) { return p + by; });
  }
}

// Subdivision of a part of the surface would open it, unless its edges stay exactly on the others.
RC_GTEST_PROP(InvarianceOfSolids, OrderFirstVertexAndSubdivision, ()) {
  Sample sample = draw_solid();
  Soup soup = subdivided(sample.soup);
  for (LatticeTriangle& t : soup)
    std::rotate(t.v.begin(), t.v.begin() + sample.random.axis(), t.v.end());
  for (size_t i = soup.size() - 1; i > 0; --i) std::swap(soup[i], soup[sample.random.below(i + 1)]);
  for (const Rule rule : {Rule::kSolid, Rule::kSolidOdd}) expect_same_solid(sample, rule, soup);
}

RC_GTEST_PROP(InvarianceOfSolids, OrientationOfTheWholeAndForOddOfEachTriangle, ()) {
  Sample sample = draw_solid();
  Soup all = sample.soup, some = sample.soup;
  for (LatticeTriangle& t : all) std::swap(t.v[0], t.v[1]);
  for (LatticeTriangle& t : some) {
    if (sample.random.coin()) std::swap(t.v[0], t.v[1]);
  }
  expect_same_solid(sample, Rule::kSolid, all);
  expect_same_solid(sample, Rule::kSolidOdd, all);
  expect_same_solid(sample, Rule::kSolidOdd, some);
}

// Duplicates do change solids: the whole surface twice winds twice around its inside.
RC_GTEST_PROP(InvarianceOfSolids, TheWholeTwiceIsTheSameForNonzeroAndASurfaceForOdd, ()) {
  Sample sample = draw_solid();
  Soup twice = sample.soup;
  twice.insert(twice.end(), sample.soup.begin(), sample.soup.end());
  expect_same_solid(sample, Rule::kSolid, twice);
  RC_ASSERT(voxelized(sample.spot, {.rule = Rule::kSolidOdd}, twice) ==
            voxelized(sample.spot, {}, sample.soup));
}

}  // namespace
}  // namespace svdag
