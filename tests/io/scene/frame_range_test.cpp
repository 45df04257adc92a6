#include "io/scene/frame_range.h"

#include <gtest/gtest.h>

#include "tests/expect_error.h"

namespace svdag {
namespace {

std::string names_of(const std::string& text) {
  const FrameRange frames = parse_frames(text);
  std::string names;
  for (uint32_t i = 0; i < frames.count; ++i) names += (i == 0 ? "" : " ") + frames.name(i);
  return names;
}

TEST(FrameRange, TheEndIsAFrameIfStepsLeadToIt) {
  EXPECT_EQ(names_of("0:1:0.25"), "0.00 0.25 0.50 0.75 1.00");
  EXPECT_EQ(names_of("0:1:0.3"), "0.0 0.3 0.6 0.9");
  EXPECT_EQ(names_of("7:7:5"), "7");
  // In doubles, 0.1 + 0.1 + 0.1 is more than 0.3.
  EXPECT_EQ(names_of("0:0.3:0.1"), "0.0 0.1 0.2 0.3");
  EXPECT_EQ(parse_frames("0:999.999:0.1").count, 10000u);
  EXPECT_EQ(parse_frames("0:1000:0.1").count, 10001u);
}

TEST(FrameRange, NamesSortByTime) {
  EXPECT_EQ(names_of("8:12:2"), "08 10 12");
  EXPECT_EQ(names_of("0.5:100.5:50"), "000.5 050.5 100.5");
}

TEST(FrameRange, TheLargestNumbers) {
  EXPECT_EQ(names_of("999999998.999999999:999999999.999999999:1"),
            "999999998.999999999 999999999.999999999");
  EXPECT_EQ(parse_frames("0:65534:1").count, 65535u);
  EXPECT_SVDAG_ERROR(parse_frames("0:65535:1"), ExitCode::kUsage, "65,536 frames");
  EXPECT_SVDAG_ERROR(parse_frames("0:1:1.0000000000"), ExitCode::kUsage, "at most 9 digits");
}

TEST(FrameRange, TimesAreTheNearestDoubles) {
  EXPECT_EQ(parse_time("000.1"), 0.1);
  EXPECT_EQ(parse_time("-1e3"), -1000);
  // Rounded to a long double first, it would be the double below.
  EXPECT_EQ(parse_time("1.00000000000000011102230246251565404236316680908203126"),
            0x1.0000000000001p0);
  for (const char* text : {"", "1s", "nan", "inf", "1e999", " 1"})
    EXPECT_SVDAG_ERROR(parse_time(text), ExitCode::kUsage, "is not a number of seconds");
}

}  // namespace
}  // namespace svdag
