#include "verify/report/report_text.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

TEST(ReportText, MarkupIsEscaped) {
  EXPECT_EQ(escaped("<script>\"a\" & b</script>"),
            "&lt;script&gt;&quot;a&quot; &amp; b&lt;/script&gt;");
}

TEST(ReportText, ShortCountsKeepThreeDigits) {
  EXPECT_EQ(short_count(0), "0");
  EXPECT_EQ(short_count(999), "999");
  EXPECT_EQ(short_count(1000), "1 K");
  EXPECT_EQ(short_count(1234), "1.23 K");
  EXPECT_EQ(short_count(99'960), "100 K");
  EXPECT_EQ(short_count(999'499), "999 K");
  EXPECT_EQ(short_count(999'999), "1 M");
  EXPECT_EQ(short_count(104'807'909), "105 M");
  EXPECT_EQ(short_count(40'872'340'497), "40.9 G");
  EXPECT_EQ(short_count(UINT64_MAX), "18447 P");
}

std::string base64_of(std::string_view text) {
  return base64(std::as_bytes(std::span(text)));
}

TEST(Base64, MatchesRfc4648) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foob"), "Zm9vYg==");
  EXPECT_EQ(base64_of("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of("\xff\xfe\xfd"), "//79");
}

}  // namespace
}  // namespace svdag
