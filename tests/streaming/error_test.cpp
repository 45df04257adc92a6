#include "streaming/error.h"

#include "tests/expect_error.h"

namespace svdag {
namespace {

TEST(Error, SentenceNamesPathFirstAndByteLast) {
  const Error error(ExitCode::kBadInput, "ends too early", "a.ply", 17);
  EXPECT_STREQ(error.what(), "a.ply: ends too early (at byte 17)");
  EXPECT_EQ(error.path(), "a.ply");
  EXPECT_EQ(error.offset(), 17U);
}

TEST(Error, WithoutPathAndOffsetIsTheSentenceAlone) {
  EXPECT_STREQ(Error(ExitCode::kUsage, "give a number").what(), "give a number");
}

TEST(Error, ReplacesControlCharacters) {
  const Error error(ExitCode::kBadInput, "has no grid \x1b[2J\n\x7f", "red\x1b[31m.vdb");
  EXPECT_STREQ(error.what(), "red?[31m.vdb: has no grid ?[2J??");
  EXPECT_EQ(error.path(), "red\x1b[31m.vdb");
}

TEST(Error, ReplacesControlCharactersOfTwoBytes) {
  const auto what = [](const char* text) {
    return std::string(Error(ExitCode::kUsage, text).what());
  };
  EXPECT_EQ(what("a\xc2\x9b"
                 "31mb\xc2\x80\xc2\x9f"),
            "a?31mb??");
  // U+00A0, U+00C2 and U+00DB with similar bytes, and a single byte at the end.
  EXPECT_EQ(what("\xc2\xa0\xc3\x82\xc3\x9b\xc2"), "\xc2\xa0\xc3\x82\xc3\x9b\xc2");
}

TEST(Error, ShorthandsHaveTheirExitCodes) {
  EXPECT_SVDAG_ERROR(fail_input("b.obj", "is broken", 3), ExitCode::kBadInput, "b.obj: is broken");
  EXPECT_SVDAG_ERROR(fail_usage("no such rule"), ExitCode::kUsage, "no such rule");
}

TEST(Error, ExitCodesAreThoseOfTheCommandLine) {
  EXPECT_EQ(int(ExitCode::kOk), 0);
  EXPECT_EQ(int(ExitCode::kDiffers), 1);
  EXPECT_EQ(int(ExitCode::kUsage), 2);
  EXPECT_EQ(int(ExitCode::kBadInput), 3);
  EXPECT_EQ(int(ExitCode::kOutput), 4);
  EXPECT_EQ(int(ExitCode::kMemory), 5);
}

TEST(Assert, NamesTheConditionAndTheFileWithoutItsFolder) {
  EXPECT_SVDAG_ERROR(SVDAG_ASSERT(1 == 2), ExitCode::kInternal,
                     "\"1 == 2\" does not hold (error_test.cpp:");
  EXPECT_NO_THROW(SVDAG_ASSERT(1 == 1));
}

}  // namespace
}  // namespace svdag
