#include "tests/io/scene/read_text.h"

namespace svdag {
namespace {

constexpr const char* kBody = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

TEST(Off, ReadsPolygonsAndIgnoresWhatFollowsInALine) {
  for (const std::string& text : std::vector<std::string>{
           std::string("OFF\n4 1 0\n") + kBody, std::string("OFF 4 1 5\n") + kBody,
           std::string("OFF # with comments\n# here\n\n4 1\n# and there\n") + kBody,
           std::string("# before\nOFF\r\n4 1 0\r\n") + kBody,
           "COFF\n4 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n1 1 0 0 0 0 0\n0 1 0 9 9 9 9\n"
           "4 0 1 2 3 0.5 0.5 0.5 1\n",
           "STCNOFF\n4 1 0\n0 0 0 0 0 1 1 1 1 1 0 0\n1 0 0 7\n1 1 0 7\n0 1 0 7\n4 0 1 2 3 3\n",
           "NCOFF\n4 1 0\n0 0 0 255 0 0 255 0 0 1\n1 0 0 1\n1 1 0 0\n0 1 0 9\n4 0 1 2 3\n",
           std::string("OFF4 1 0\n") + kBody, std::string("COFF4 1\n0\n") + kBody,
           std::string("\xEF\xBB\xBFOFF\n4 1 0\n") + kBody,
           std::string("NOFF 4 1 0\n\n") + kBody}) {
    EXPECT_EQ(read(read_off, text).triangles, (std::vector<Corners>{kLower, kUpper})) << text;
  }
}

TEST(Off, TextIsReadToTheNearestDouble) {
  EXPECT_EQ(read(read_off, "OFF 3 1 0\n0.1 0 0\n1 0 0\n0 1 0\n3 0 1 2").triangles.at(0)[0][0], 0.1);
}

TEST(Off, OtherKindsOfOffAreRefusedByName) {
  EXPECT_NE(refusal(read_off, "OFF BINARY\n\1\2\3").find("binary OFF"), std::string::npos);
  EXPECT_NE(refusal(read_off, "4OFF\n1 0 0\n0 0 0 1\n").find("dimension"), std::string::npos);
  EXPECT_NE(refusal(read_off, "nOFF\n3\n1 0 0\n").find("dimension"), std::string::npos);
  EXPECT_NE(refusal(read_off, "4 1 0\n").find("does not begin"), std::string::npos);
}

TEST(Off, CountsThatTheFileCannotHoldAreRefused) {
  for (const char* counts : {"1000 1 0", "999999999999999999 1 0", "4 1000 0", "-1 1 0"}) {
    EXPECT_NE(refusal(read_off, "OFF\n" + std::string(counts) + "\n" + kBody).find("promises"),
              std::string::npos);
  }
  EXPECT_NE(refusal(read_off, "OFF\n99999999999999999999 1 0\n"), "");
  EXPECT_NE(refusal(read_off, "OFF 1 1 0\n0 0 0\n999999 0\n").find("corners"), std::string::npos);
}

TEST(Off, EveryTruncationIsRefused) {
  expect_no_truncation_goes_unnoticed(read_off, std::string("OFF\n4 1 0\n") + kBody, 1);
}

TEST(Off, IndicesThatPointNowhereAreRefusedWithTheirLine) {
  for (const char* index : {"3", "-1"}) {
    const std::string text = std::string("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 ") + index;
    EXPECT_NE(refusal(read_off, text).find("(line 6)"), std::string::npos);
  }
}

}  // namespace
}  // namespace svdag
