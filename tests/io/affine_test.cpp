#include "io/affine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "streaming/error.h"

namespace svdag {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& transform) {
  try {
    parse_transform(transform);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    return error.what();
  }
  return "";
}

TEST(Affine, ATransformIsReadRowByRowWithOrWithoutItsLastRow) {
  const Affine a = parse_transform("1,2,3,4,0,1,0,5,0,0,1,6");
  EXPECT_EQ(a(Point(1, 1, 1)), Point(10, 6, 7));
  EXPECT_EQ(parse_transform("1,2,3,4,0,1,0,5,0,0,1,6,0,0,0,1"), a);
  EXPECT_EQ(parse_transform(format_transform(a)), a);
}

TEST(Affine, AMatrixThatIsNotAffineOrFlattensIsRefused) {
  EXPECT_THAT(refusal(""), HasSubstr("16 numbers"));
  EXPECT_THAT(refusal("1,2,3"), HasSubstr("16 numbers"));
  EXPECT_THAT(refusal("1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2"), HasSubstr("16 numbers"));
  EXPECT_THAT(refusal("1,0,0,0,0,1,0,0,0,0,1,x"), HasSubstr("16 numbers"));
  EXPECT_THAT(refusal("1,0,0,0,0,1,0,0,1,1,0,0"), HasSubstr("flattens"));
  EXPECT_THAT(refusal("1,0,0,nan,0,1,0,0,0,0,1,0"), HasSubstr("flattens"));
}

TEST(Affine, UpIsRotatedToYWithoutMirroring) {
  const std::pair<const char*, Point> axes[] = {{"x", {1, 0, 0}},   {"y", {0, 1, 0}},
                                                {"z", {0, 0, 1}},   {"-x", {-1, 0, 0}},
                                                {"-y", {0, -1, 0}}, {"-z", {0, 0, -1}}};
  for (const auto& [name, axis] : axes) {
    const Affine up = parse_up(name);
    EXPECT_EQ(up(axis), Point(0, 1, 0)) << name;
    EXPECT_FALSE(is_mirror(up)) << name;
  }
  EXPECT_THROW(parse_up("w"), Error);
}

TEST(Affine, ANegativeDeterminantIsAMirror) {
  EXPECT_TRUE(is_mirror(scaling(-1)));
  EXPECT_TRUE(is_mirror(parse_transform("0,1,0,0,1,0,0,0,0,0,1,0")));
  EXPECT_FALSE(is_mirror(scaling(2)));
}

}  // namespace
}  // namespace svdag
