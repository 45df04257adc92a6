#include "streaming/spill/work_array.h"

#include <gtest/gtest.h>

#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

TEST(WorkArray, LeavesHalfOfTheBudgetAndIsZeroWhereverItIs) {
  const TempFolder folder;
  MemoryBudget budget(1 << 20);
  const WorkRoom room{&budget, folder.path()};
  for (const uint64_t bytes : {0U, 1U << 18, 1U << 19, (1U << 19) + 8, 1U << 21}) {
    WorkArray<uint64_t> array(bytes / 8, room);
    EXPECT_EQ(budget.used(), bytes <= 1 << 19 ? bytes : 0) << bytes;
    for (uint64_t i = 0; i < array.size(); ++i) {
      ASSERT_EQ(array[i], 0U);
      array[i] = i;
    }
    for (uint64_t i = 0; i < array.size(); ++i) ASSERT_EQ(array[i], i);
  }
  EXPECT_EQ(budget.used(), 0U);
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(WorkArray, AFullDiskIsAnErrorBeforeTheArrayIsUsed) {
  const TempFolder folder;
  MemoryBudget budget(1 << 20);
  const WorkRoom room{&budget, folder.path()};
  EXPECT_SVDAG_ERROR(WorkArray<uint64_t>(uint64_t(1) << 50, room), ExitCode::kOutput,
                     "has less than 9007199255 MB free");
  EXPECT_EQ(folder.entries(), 0U);
}

}  // namespace
}  // namespace svdag
