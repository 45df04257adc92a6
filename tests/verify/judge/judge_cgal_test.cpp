// Tests that the two judges agree, triangle by triangle, and in full and sampled comparisons.
#include "verify/judge/judge_cgal.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/expect_error.h"
#include "tests/verify/families.h"
#include "tests/verify/judged_voxels.h"
#include "tests/verify/soup.h"
#include "verify/sample/sample.h"

namespace svdag {
namespace {

#ifndef SVDAG_HAS_CGAL

TEST(CgalJudge, IsRejectedInABuildWithoutCgal) {
  EXPECT_SVDAG_ERROR(make_cgal_judge(Rule::kThin), ExitCode::kUsage, "built without CGAL");
}

#else

constexpr VoxelBox kCgalWindow{LatticePoint(-64), LatticePoint(64)};
constexpr JudgeChoice::Kind kCgal = JudgeChoice::Kind::kCgal;

// Compares both judges with both rules, one triangle at a time, and counts the voxels they set.
class Agreement {
 public:
  ::testing::AssertionResult check(const LatticeTriangle& t, int shift, const VoxelBox& window) {
    for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
      Judge& integer = *integer_[size_t(rule)];
      Judge& cgal = *cgal_[size_t(rule)];
      const VoxelSet expected = judged_voxels(integer, t, shift, window);
      if (judged_voxels(cgal, t, shift, window) != expected)
        return ::testing::AssertionFailure() << rule_name(rule);
      set_[size_t(rule)] += expected.size();
    }
    if (changes(*integer_[0], t, shift, window) != changes(*cgal_[0], t, shift, window))
      return ::testing::AssertionFailure() << "winding numbers";
    changes_ += changes(*integer_[0], t, shift, window).size();
    return ::testing::AssertionSuccess();
  }
  size_t conservative() const { return set_[0]; }
  size_t thin() const { return set_[1]; }
  size_t windings() const { return changes_; }

 private:
  using Pair = std::array<std::unique_ptr<Judge>, 2>;
  Pair integer_{make_judge({}), make_judge({JudgeChoice::Kind::kInteger, Rule::kThin})};
  Pair cgal_{make_judge({kCgal, Rule::kConservative}), make_judge({kCgal, Rule::kThin})};
  using Changes = std::set<std::array<int64_t, 4> >;
  static Changes changes(Judge& judge, const LatticeTriangle& t, int shift,
                         const VoxelBox& window) {
    Changes changes;
    judge.windings(t, shift, window, [&](const LatticePoint& voxel, int change) {
      changes.insert({voxel.x, voxel.y, voxel.z, change});
    });
    return changes;
  }

  std::array<size_t, 2> set_{};
  size_t changes_ = 0;
};

TEST(CgalJudge, AgreesOnEveryFamilyAndSize) {
  std::mt19937_64 random(1);
  for (int family = 0; family < kFamilies; ++family) {
    Agreement judges;
    for (int i = 0; i < 60; ++i) {
      const int64_t reach = std::array<int64_t, 3>{kSide, 3 * kSide, 10 * kSide}[size_t(i % 3)];
      const LatticeTriangle t = family_triangle(random, family, reach);
      ASSERT_TRUE(judges.check(t, kShift, kCgalWindow)) << "family " << family << ", triangle " << i;
    }
    EXPECT_GT(judges.conservative(), 100U);
    EXPECT_EQ(judges.thin() == 0, family >= 3 && family <= 5);  // the families of zero area
    EXPECT_EQ(judges.windings() == 0, family >= 3 && family <= 5);
  }
}

TEST(CgalJudge, AgreesOnSliversOnAFineLattice) {
  std::mt19937_64 random(2);
  const int shift = 23;
  Agreement judges;
  for (int i = 0; i < 100; ++i) {
    LatticeTriangle t;
    for (LatticePoint& p : t.v) {
      for (int a = 0; a < 3; ++a) p[a] = int64_t(random() % (uint64_t(12) << shift));
    }
    t.v[2] = t.v[0] + (t.v[1] - t.v[0]) / int64_t(3);
    t.v[2][i % 3] += int64_t(random() % 3);  // aspect 10^7 and more
    ASSERT_TRUE(judges.check(t, shift, kCgalWindow)) << i;
  }
  EXPECT_GT(judges.conservative(), 1000U);
}

TEST(CgalJudge, AgreesOnGiantsWithinAndBeyond128Bits) {
  std::mt19937_64 random(3);
  const int shift = 23;
  const VoxelBox window{LatticePoint(-6), LatticePoint(6)};
  Agreement judges;
  for (int i = 0; i < 150; ++i) {
    LatticeTriangle t = random_giant(random, i % 2 == 0);
    if (i % 3 != 0) t.v[2] = -t.v[0] - t.v[1] + LatticePoint(int64_t(random() % 100000000));
    if (i % 5 == 0) t.v[2] = t.v[0];  // a long segment
    ASSERT_TRUE(judges.check(t, shift, window)) << i;
  }
  EXPECT_GT(judges.conservative(), 1000U);
  EXPECT_GT(judges.thin(), 500U);
}

// For each rule, both comparisons with CGAL find the one voxel that the file lacks.
TEST(CgalJudge, ComparesWholeFilesAndSamplesOfBothRules) {
  const Grid grid = test_grid(6);
  const auto soup = random_soup(grid, 25, 4, 12);
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    const auto integer = make_judge({JudgeChoice::Kind::kInteger, rule});
    VoxelSet voxels;
    for (const LatticeTriangle& t : soup)
      voxels.merge(judged_voxels(*integer, t, grid.fraction(), grid.selection));
    const size_t expected = voxels.size();
    ASSERT_GT(expected, 100U);
    voxels.erase(voxels.begin());
    const RawFile file(raw_dag(grid, voxels));
    ParallelExecutor executor(2);
    Progress progress;
    const Comparison all = compare_all(file.view(), grid, soup, {kCgal, rule}, executor, progress);
    EXPECT_EQ(all.judge_voxels, expected);
    EXPECT_EQ(all.missing, 1U);
    EXPECT_EQ(all.extra, 0U);

    std::vector<uint64_t> codes(size_t(1) << (3 * (grid.levels - 2)));
    for (size_t i = 0; i < codes.size(); ++i) codes[i] = i;
    BrickSample sample(grid, codes);
    const auto judge = make_judge({kCgal, rule});
    for (const LatticeTriangle& t : soup) sample.add(t, *judge);
    const Comparison sampled = sample.compare(file.view());
    EXPECT_EQ(sampled.judge_voxels, expected);
    EXPECT_EQ(sampled.missing, 1U);
  }
}

#endif

}  // namespace
}  // namespace svdag
