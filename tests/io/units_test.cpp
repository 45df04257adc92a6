#include "io/units.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cstdlib>

#include "tests/expect_error.h"

namespace svdag {
namespace {

TEST(Units, SuffixesArePowersOf1024) {
  EXPECT_EQ(parse_count("0", "-m"), 0U);
  EXPECT_EQ(parse_count("512", "-m"), 512U);
  EXPECT_EQ(parse_count("64K", "-m"), 65536U);
  EXPECT_EQ(parse_count("64k", "-m"), 65536U);
  EXPECT_EQ(parse_count("4GiB", "-m"), uint64_t(4) << 30);
  EXPECT_EQ(parse_count("4GB", "-m"), uint64_t(4) << 30);
  EXPECT_EQ(parse_count("2T", "-m"), uint64_t(2) << 40);
}

TEST(Units, AnInvalidNumberIsReportedWithItsOption) {
  for (const char* text : {"", "K", "-1", "1.5G", "4 G", "4X", "4GG", "4Ki", "0x10", "+3",
                           "18446744073709551616", "16777216T", "9999999999999G"})
    EXPECT_SVDAG_ERROR(parse_count(text, "--memory"), ExitCode::kUsage,
                       "--memory: \"" + std::string(text) + "\" is not a number");
}

TEST(Units, ResolutionsArePowersOfTwoFrom8To1M) {
  for (int levels = 3; levels <= 20; ++levels) {
    const uint64_t n = uint64_t(1) << levels;
    EXPECT_EQ(parse_resolution(std::to_string(n)), levels);
    EXPECT_EQ(parse_resolution(format_resolution(n)), levels);
  }
  for (const char* text : {"0", "1", "4", "1000", "3K", "2M", "64G", "x"})
    EXPECT_SVDAG_ERROR(parse_resolution(text), ExitCode::kUsage, "--resolution");
}

TEST(Units, FormatsNumbers) {
  EXPECT_EQ(format_resolution(8), "8");
  EXPECT_EQ(format_resolution(1000), "1000");
  EXPECT_EQ(format_resolution(65536), "64K");
  EXPECT_EQ(format_resolution(1 << 20), "1M");
  EXPECT_EQ(format_bytes(0), "0 bytes");
  EXPECT_EQ(format_bytes(1023), "1023 bytes");
  EXPECT_EQ(format_bytes(1536), "1.5 KiB");
  EXPECT_EQ(format_bytes(UINT64_MAX), "16.0 EiB");
  EXPECT_EQ(format_count(0), "0");
  EXPECT_EQ(format_count(999), "999");
  EXPECT_EQ(format_count(1000), "1,000");
  EXPECT_EQ(format_count(1, "open edge"), "1 open edge");
  EXPECT_EQ(format_count(1000, "layer"), "1,000 layers");
  EXPECT_EQ(format_count(1234567), "1,234,567");
}

RC_GTEST_PROP(Units, ACountReadsBackFromItsResolutionText, (uint32_t n)) {
  RC_ASSERT(parse_count(format_resolution(n), "-r") == n);
}

RC_GTEST_PROP(Units, ADoubleReadsBackFromItsText, (uint64_t bits)) {
  const double value = std::bit_cast<double>(bits);
  RC_PRE(value == value);
  RC_ASSERT(std::strtod(format_double(value).c_str(), nullptr) == value);
}

TEST(Units, DoublesHaveTheShortestText) {
  EXPECT_EQ(format_double(0.1), "0.1");
  EXPECT_EQ(format_double(-3), "-3");
  EXPECT_EQ(format_double(1e300), "1e+300");
}

}  // namespace
}  // namespace svdag
