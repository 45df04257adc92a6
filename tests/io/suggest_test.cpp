// Tests the suggestions for misspelt words.
#include "io/suggest.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

TEST(Suggest, CountsLeftOutAddedChangedAndSwappedLetters) {
  EXPECT_EQ(edit_distance("build", "build"), 0U);
  EXPECT_EQ(edit_distance("buid", "build"), 1U);
  EXPECT_EQ(edit_distance("builld", "build"), 1U);
  EXPECT_EQ(edit_distance("bulid", "build"), 1U);
  EXPECT_EQ(edit_distance("bield", "build"), 2U);
  EXPECT_EQ(edit_distance("", "info"), 4U);
}

TEST(Suggest, FindsTheNearestWord) {
  const std::vector<std::string> words = {"build", "info", "plan"};
  EXPECT_EQ(nearest("biuld", words), "build");
  EXPECT_EQ(nearest("frobnicate", words), "");
  const std::vector<std::string> options = {"--resolution", "--progress", "--resume", "-r"};
  EXPECT_EQ(nearest("--reso", options), "--resolution");
  EXPECT_EQ(nearest("--res", options), "--resolution");
  EXPECT_EQ(nearest("", options), "");
}

TEST(Suggest, FindsTheProgramThatHasACommand) {
  EXPECT_EQ(command_of_other_program("render"), "svdag-verify render");
  EXPECT_EQ(command_of_other_program("trace"), "svdag-trace");
  EXPECT_EQ(command_of_other_program("svdag-trace"), "svdag-trace");
  EXPECT_EQ(command_of_other_program("build"), "svdag build");
  EXPECT_EQ(command_of_other_program("import"), "svdag import");
  for (const char* word : {"", " ", "b", "uild", "build plan", "checks"})
    EXPECT_EQ(command_of_other_program(word), "") << word;
}

}  // namespace
}  // namespace svdag
