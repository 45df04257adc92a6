// The self-test: right for every kernel, wrong for one that errs in one voxel.
#include "builder/descend/self_test.h"

#include <gtest/gtest.h>

#include "tests/expect_error.h"

namespace svdag {
namespace {

constexpr Rule kRules[] = {Rule::kConservative, Rule::kThin};

TEST(SelfTest, AsksEveryKernelAHundredThousandQuestions) {
  std::vector<Kernels> all = vector_kernels();
  all.push_back(plain_kernels());
  for (const Rule rule : kRules) {
    for (const Kernels& kernels : all) {
      for (const bool memo : {false, true}) {
        DescentConfig config;
        config.rule = rule;
        config.kernels = &kernels;
        config.plane_memo = config.patches = memo;
        EXPECT_GE(self_test(config), 100'000U) << kernels.name;
      }
    }
  }
}

int answers = 0;  // that are right before one is wrong

template <Kernels::Voxels Kernels::*kVoxels>
Brick err_once(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
               int fraction, Brick wanted, DecisionCounts* counts) noexcept {
  const Brick brick = (plain_kernels().*kVoxels)(entries, count, corner, fraction, wanted, counts);
  return answers-- == 0 ? brick ^ (wanted & -wanted) : brick;
}

TEST(SelfTest, FindsOneWrongVoxel) {
  Kernels kernels = plain_kernels();
  kernels.conservative = err_once<&Kernels::conservative>;
  kernels.thin = err_once<&Kernels::thin>;
  for (const Rule rule : kRules) {
    for (const int right : {0, 10, 100}) {
      answers = right;
      DescentConfig config;
      config.rule = rule;
      config.kernels = &kernels;
      EXPECT_SVDAG_ERROR(self_test(config), ExitCode::kInternal, "computes other voxels");
      EXPECT_LT(answers, 0);
    }
  }
}

}  // namespace
}  // namespace svdag
