// The self-test passes for every kernel and fails for a kernel with one wrong voxel.
#include "builder/descend/self_test.h"

#include <gtest/gtest.h>

#include "tests/expect_error.h"

namespace svdag {
namespace {

constexpr Rule kRules[] = {Rule::kConservative, Rule::kThin};

TEST(SelfTest, ComparesAHundredThousandVoxelsWithEveryKernel) {
  std::vector<Kernels> all = vector_kernels();
  all.push_back(plain_kernels());
  for (const Rule rule : kRules) {
    for (const Kernels& kernels : all) {
      for (const bool fast : {false, true}) {
        DescentConfig config;
        config.rule = rule;
        config.kernels = &kernels;
        config.plane_memo = config.patches = config.cubes = fast;
        EXPECT_GE(self_test(config), 100'000U) << kernels.name;
      }
    }
  }
}

int correct_calls = 0;  // calls left before the wrong one

template <RuleKernels Kernels::*kRule>
Brick err_once(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
               int fraction, Brick wanted, DecisionCounts* counts) noexcept {
  const Brick brick =
      (plain_kernels().*kRule).brick(entries, count, corner, fraction, wanted, counts);
  return correct_calls-- == 0 ? brick ^ (wanted & -wanted) : brick;
}

template <RuleKernels Kernels::*kRule>
uint32_t err_once_in_cube(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                          int fraction, bool covering, Brick out[8],
                          DecisionCounts* counts) noexcept {
  const uint32_t voxels =
      (plain_kernels().*kRule).cube(entries, count, corner, fraction, covering, out, counts);
  if (correct_calls-- != 0) return voxels;
  out[3] ^= 1;
  return (out[3] & 1) != 0 ? voxels + 1 : voxels - 1;
}

TEST(SelfTest, FindsOneWrongVoxel) {
  Kernels kernels = plain_kernels();
  kernels.conservative = {err_once<&Kernels::conservative>,
                          err_once_in_cube<&Kernels::conservative>};
  kernels.thin = {err_once<&Kernels::thin>, err_once_in_cube<&Kernels::thin>};
  for (const Rule rule : kRules) {
    for (const bool cubes : {false, true}) {
      for (const int correct : {0, 10, 100}) {
        correct_calls = correct;
        DescentConfig config;
        config.rule = rule;
        config.kernels = &kernels;
        config.cubes = cubes;
        EXPECT_SVDAG_ERROR(self_test(config), ExitCode::kInternal, "computes wrong voxels");
        EXPECT_LT(correct_calls, 0);
      }
    }
  }
}

}  // namespace
}  // namespace svdag
