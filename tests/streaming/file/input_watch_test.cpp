// A change of a watched file is reported, and whatever it caused is not.
#include "streaming/file/input_watch.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

TEST(InputWatch, ReportsAWriteToAnOpenFile) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("a", "one"));
  InputWatch watch;
  watch.add(file);
  watch.check();
  folder.write("a", "three");
  EXPECT_SVDAG_ERROR(watch.check(), ExitCode::kBadInput, "a: was changed while it was read");
}

TEST(InputWatch, AnotherFileOfTheNameIsAChangeOnlyIfItIsReopened) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("a", "one"));
  InputWatch open, reopened;
  open.add(file);
  reopened.add_reopened(file);
  std::filesystem::rename(folder.write("b", "one"), folder.file("a"));
  open.check();
  EXPECT_SVDAG_ERROR(reopened.check(), ExitCode::kBadInput, "a: was changed while it was read");
}

TEST(InputWatch, BlamesAChangeForAnyError) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("a", "one"));
  InputWatch watch;
  watch.add(file);
  const auto fail = [&]() -> int { throw std::runtime_error("a consequence"); };
  EXPECT_EQ(watch.guard([] { return 7; }), 7);
  EXPECT_THROW(watch.guard(fail), std::runtime_error);
  folder.write("a", "three");
  EXPECT_SVDAG_ERROR(watch.guard(fail), ExitCode::kBadInput, "was changed while it was read");
  EXPECT_SVDAG_ERROR(watch.guard([] { return 7; }), ExitCode::kBadInput,
                     "was changed while it was read");
}

}  // namespace
}  // namespace svdag
