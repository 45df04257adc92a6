// Tests that the first wrong word of a command line is named, with a suggestion.
#include "io/help/usage_error.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

Manual command_with(const std::string& name, const std::vector<std::vector<std::string>>& options) {
  Manual command;
  command.command = name;
  for (const auto& names : options) {
    const bool is_flag = names.back() == "--help" || names.back() == "--json";
    command.options.push_back({names, is_flag ? "" : "N", "", "", {}, {}});
  }
  return command;
}

std::string explain(const std::vector<std::string>& words) {
  Manual program = command_with("svdag", {{"-h", "--help"}});
  program.commands = {
      command_with("svdag build", {{"-o", "--output"}, {"-r", "--resolution"}, {"-h", "--help"}}),
      command_with("svdag info", {{"--json"}, {"--level"}})};
  return explain_words(program, words);
}

TEST(UsageError, SuggestsASimilarCommand) {
  EXPECT_EQ(explain({"biuld", "x.ply"}), "unknown command \"biuld\" of svdag; did you mean build?");
  EXPECT_EQ(explain({"frobnicate"}), "unknown command \"frobnicate\" of svdag; see svdag --help");
}

// Takes precedence over similar words: "trace" is not a misspelt "plan".
TEST(UsageError, SuggestsTheProgramThatHasTheCommand) {
  EXPECT_EQ(explain({"check", "x.svdag"}),
            "unknown command \"check\" of svdag; did you mean svdag-verify check?");
  EXPECT_EQ(explain({"verify", "check", "x.svdag"}),
            "unknown command \"verify\" of svdag; did you mean svdag-verify?");
}

TEST(UsageError, SuggestsASimilarOption) {
  EXPECT_EQ(explain({"build", "x.ply", "--resolutoin=64"}),
            "unknown option --resolutoin of svdag build; did you mean --resolution?");
  EXPECT_EQ(explain({"info", "--quickly"}),
            "unknown option --quickly of svdag info; see svdag info --help");
  EXPECT_EQ(explain({"--hlep"}), "unknown option --hlep of svdag; did you mean --help?");
}

TEST(UsageError, ExpectsNoCommandOfAProgramWithoutCommands) {
  const Manual program = command_with("svdag export", {{"--output"}, {"--level"}});
  const std::vector<std::string> line = {"a.svdag", "--levle", "3"};
  EXPECT_EQ(explain_words(program, line),
            "unknown option --levle of svdag export; did you mean --level?");
}

TEST(UsageError, NamesAnOptionWithoutItsValue) {
  const std::string see = "; see svdag build --help";
  EXPECT_EQ(explain({"build", "-o", "-r", "64"}), "-o: its value is missing before -r" + see);
  EXPECT_EQ(explain({"build", "-o", "-r64"}), "-o: its value is missing before -r64" + see);
  EXPECT_EQ(explain({"build", "-o", ""}), "-o: the value is empty" + see);
  EXPECT_EQ(explain({"build", "--output=", "x.ply"}), "--output: the value is empty" + see);
  EXPECT_EQ(explain({"build", "-o=x"}),
            "-o=x: the value starts with \"=\": remove the \"=\"" + see);
}

TEST(UsageError, HasNoMessageForKnownOptionsAndOtherArguments) {
  EXPECT_EQ(explain({"build", "x.ply", "-o4", "-r", "64K", "--output==thin"}), "");
  EXPECT_EQ(explain({"build", "-o", "--strange", "-5", "-", "--", "--strange.ply"}), "");
  EXPECT_EQ(explain({"build", "--help", "--strange"}), "");
  EXPECT_EQ(explain({"build", "-o"}), "");  // CLI11 reports it
  EXPECT_EQ(explain({}), "");
}

// The messages on the left are those of CLI11 2.1 to 2.4.
TEST(PlainUsageError, RestatesTheMessagesOfTheParser) {
  const std::pair<const char*, const char*> cases[] = {
      {"--size: At Most 1 required but received 2", "--size: is given more than once"},
      {"--size: 1 required WxH missing", "--size: the value is missing"},
      {"Exactly 1 option from [-r,--resolution,-s,--voxel-size]",
       "give one of --resolution or --voxel-size"},
      {"Exactly 1 option from [-r,--resolution,-s,--voxel-size] is required",
       "give one of --resolution or --voxel-size"},
      {"Exactly 1 option from [-r,--resolution,-s,--voxel-size] is required and 2 were given",
       "give only one of --resolution or --voxel-size"},
      {"Requires at most 1 options be given from [--resume,--restart]",
       "give only one of --resume or --restart"},
      {"Could not convert: --checkpoint = soon", "--checkpoint: \"soon\" is not a number"},
      {"--no-cut excludes --resume", "--no-cut cannot be combined with --resume"},
      {"The following argument was not expected: -5", "unexpected argument: -5"},
      {"--output is required", "--output is required"},
  };
  for (const auto& [message, plain] : cases) EXPECT_EQ(plain_usage_error(message), plain);
}

}  // namespace
}  // namespace svdag
