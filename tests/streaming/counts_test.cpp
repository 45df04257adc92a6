#include "streaming/counts.h"

#include <gtest/gtest.h>

#include "tests/expect_error.h"

namespace svdag {
namespace {

TEST(Counts, LargerThan32BitsAreAnError) {
  EXPECT_EQ(as_u32(0, "runs"), 0U);
  EXPECT_EQ(as_u32(UINT32_MAX, "runs"), UINT32_MAX);
  EXPECT_SVDAG_ERROR(as_u32(uint64_t(1) << 32, "runs"), ExitCode::kMemory,
                     "more than 2^32 - 1 runs: lower the resolution");
}

}  // namespace
}  // namespace svdag
