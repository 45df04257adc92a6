#include "io/colour.h"

#include <gtest/gtest.h>

#include <limits>

namespace svdag {
namespace {

long double exact_light(long double code) {
  const long double v = code / 255;
  return v <= 0.04045L ? v / 12.92L : std::pow((v + 0.055L) / 1.055L, 2.4L);
}

TEST(Colour, CodesComeBackFromTheirLight) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(code_of_units(light_units(light_of(code))), code);
    if (code == 255) continue;
    const uint64_t border = light_units(light_of(code + 0.5));
    EXPECT_EQ(code_of_units(border), code + 1);
    EXPECT_EQ(code_of_units(border - 1), code);
  }
}

// Then a light that is wrong by a million units in the last place gives the same tables.
TEST(Colour, NoUnitsAreCloseToTheMiddleBetweenTwo) {
  for (int half = 0; half < 511; ++half) {
    const long double units = exact_light(half / 2.0L) * double(kWhiteUnits);
    EXPECT_GT(std::abs(units - std::floor(units) - 0.5L), 0.0005L) << half;
    EXPECT_EQ(light_units(light_of(half / 2.0)), uint64_t(std::llround(units))) << half;
  }
}

TEST(Colour, FactorsAreClamped) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(LinearColour().times({1, 0, 0.5}), (Colour{255, 0, 188}));
  EXPECT_EQ(LinearColour().times({7, -1, kNone}), (Colour{255, 0, 0}));
  const LinearColour grey{{kWhiteUnits / 2, kWhiteUnits / 2, kWhiteUnits / 2}};
  EXPECT_EQ(grey.times({1, 2, 0.5}), (Colour{188, 255, 137}));
}

}  // namespace
}  // namespace svdag
