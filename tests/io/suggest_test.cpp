// Tests the suggestions for misspelt words.
#include "io/suggest.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

const std::vector<CommandWords> kCommands = {
    {"", {"--help", "--version"}},
    {"build", {"-o", "--output", "-r", "--resolution", "--rule", "-j", "--threads", "--help"}},
    {"info", {"--json", "--levels"}}};

std::string explain(const std::vector<std::string>& arguments) {
  return explain_unknown("svdag", kCommands, arguments);
}

TEST(Suggest, CountsLeftOutAddedChangedAndSwappedLetters) {
  EXPECT_EQ(edit_distance("build", "build"), 0U);
  EXPECT_EQ(edit_distance("buid", "build"), 1U);
  EXPECT_EQ(edit_distance("builld", "build"), 1U);
  EXPECT_EQ(edit_distance("bulid", "build"), 1U);
  EXPECT_EQ(edit_distance("bield", "build"), 2U);
  EXPECT_EQ(edit_distance("", "info"), 4U);
}

TEST(Suggest, SuggestsASimilarCommand) {
  EXPECT_EQ(explain({"biuld", "x.ply"}), "unknown command \"biuld\" of svdag; did you mean build?");
  EXPECT_EQ(explain({"frobnicate"}), "unknown command \"frobnicate\" of svdag; see svdag --help");
}

// Takes precedence over similar words: "trace" is not a misspelt "plan".
TEST(Suggest, SuggestsTheProgramThatHasTheCommand) {
  EXPECT_EQ(explain({"check", "x.svdag"}),
            "unknown command \"check\" of svdag; did you mean svdag-verify check?");
  EXPECT_EQ(explain({"verify", "check", "x.svdag"}),
            "unknown command \"verify\" of svdag; did you mean svdag-verify?");
  EXPECT_EQ(command_of_other_program("render"), "svdag-verify render");
  EXPECT_EQ(command_of_other_program("trace"), "svdag-trace");
  EXPECT_EQ(command_of_other_program("svdag-trace"), "svdag-trace");
  EXPECT_EQ(command_of_other_program("build"), "svdag build");
  EXPECT_EQ(command_of_other_program("import"), "svdag import");
  for (const char* word : {"", " ", "b", "uild", "build plan", "checks"})
    EXPECT_EQ(command_of_other_program(word), "") << word;
}

TEST(Suggest, SuggestsASimilarOption) {
  EXPECT_EQ(explain({"build", "x.ply", "--resolutoin=64"}),
            "unknown option --resolutoin of svdag build; did you mean --resolution?");
  EXPECT_EQ(explain({"info", "--quickly"}),
            "unknown option --quickly of svdag info; see svdag info --help");
}

TEST(Suggest, IncludesTheOptionsOfTheProgramItself) {
  EXPECT_EQ(explain({"--vesrion"}), "unknown option --vesrion of svdag; did you mean --version?");
  EXPECT_EQ(explain({"--version"}), "");
}

TEST(Suggest, ExpectsNoCommandOfAProgramWithoutCommands) {
  const std::vector<CommandWords> alone = {{"", {"--output", "--level"}}};
  const std::vector<std::string> line = {"a.svdag", "--levle", "3"};
  EXPECT_EQ(explain_unknown("svdag export", alone, line),
            "unknown option --levle of svdag export; did you mean --level?");
}

TEST(Suggest, HasNoMessageForKnownOptionsAndOtherArguments) {
  EXPECT_EQ(explain({"build", "x.ply", "-j4", "-r", "64K", "--rule=thin"}), "");
  EXPECT_EQ(explain({"build", "-5", "--", "--strange.ply"}), "");
  EXPECT_EQ(explain({}), "");
}

// The messages on the left are those of CLI11 2.3.
TEST(PlainUsageError, RestatesTheMessagesOfTheParser) {
  const std::pair<const char*, const char*> cases[] = {
      {"--size: At Most 1 required but received 2", "--size: is given more than once"},
      {"--size: 1 required WxH missing", "--size: the value is missing"},
      {"Exactly 1 option from [-r,--resolution,-s,--voxel-size] is required",
       "give one of --resolution or --voxel-size"},
      {"Exactly 1 option from [-r,--resolution,-s,--voxel-size] is required and 2 were given",
       "give only one of --resolution or --voxel-size"},
      {"Could not convert: --checkpoint = soon", "--checkpoint: \"soon\" is not a number"},
      {"--no-cut excludes --resume", "--no-cut cannot be combined with --resume"},
      {"The following argument was not expected: -5", "unexpected argument: -5"},
      {"--output is required", "--output is required"},
  };
  for (const auto& [message, plain] : cases) EXPECT_EQ(plain_usage_error(message), plain);
}

}  // namespace
}  // namespace svdag
