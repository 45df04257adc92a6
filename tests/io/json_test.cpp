// Tests that an integer in JSON is read exactly or is an Error.
#include "io/json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/expect_error.h"

namespace svdag {
namespace {

using Json = nlohmann::json;

TEST(JsonNumber, IsReadExactly) {
  EXPECT_EQ(whole_number<uint64_t>(Json::parse("18446744073709551615")), UINT64_MAX);
  EXPECT_EQ(whole_number<int64_t>(Json::parse("-9223372036854775808")), INT64_MIN);
  EXPECT_EQ(whole_number<int>(Json::parse("-7")), -7);
  EXPECT_EQ(whole_number<uint8_t>(Json::parse("255")), 255);
}

TEST(JsonNumber, ThatIsNotAnIntegerOrOutOfRangeIsAnError) {
  const auto read = [](const char* text) { return whole_number<int>(Json::parse(text)); };
  for (const char* text : {"4294967305", "-4294967289", "1e24", "-1e24", "7.0", "1e300", "true",
                           "null", "\"7\"", "[7]", "18446744073709551616"}) {
    EXPECT_SVDAG_ERROR(read(text), ExitCode::kBadInput, "out of range");
  }
  EXPECT_SVDAG_ERROR(whole_number<uint64_t>(Json::parse("-1")), ExitCode::kBadInput,
                     "out of range");
}

}  // namespace
}  // namespace svdag
