// The judge's texture: light, wrap modes, bilinear samples, weights of what is cut out.
#include "verify/colours/judged_texture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace svdag {
namespace {

// Texel i of four in a row has code 10 i.
JudgedTexture row(double threshold = 0) {
  std::vector<uint8_t> rgba;
  for (int i = 0; i < 4; ++i) {
    const uint8_t code = uint8_t(10 * i);
    rgba.insert(rgba.end(), {code, code, code, uint8_t(i == 2 ? 100 : 255)});
  }
  return {4, 1, rgba, threshold};
}

Paint paint(Wrap wrap, bool nearest) {
  Paint paint;
  paint.wrap_u = paint.wrap_v = wrap;
  paint.nearest = nearest;
  return paint;
}

TEST(JudgedTexture, LightIsThatOfTheStandard) {
  EXPECT_EQ(light_of_srgb(0), 0);
  EXPECT_EQ(light_of_srgb(255), 1);
  EXPECT_NEAR(light_of_srgb(128), 0.21586, 1e-5);
  EXPECT_NEAR(light_of_srgb(5), 5 / 255.0 / 12.92, 1e-12);
  for (double code = 0; code <= 255; code += 0.5)
    EXPECT_NEAR(srgb_of_light(light_of_srgb(code)), code, 1e-4);
}

TEST(JudgedTexture, WrapModesAreThoseOfGltf) {
  const JudgedTexture texture = row();
  const int repeat[] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},
            mirror[] = {3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0};
  for (int i = -4; i < 8; ++i) {
    const auto at = [&](Wrap wrap) { return texture.at(paint(wrap, true), i + 0.75, 0.5)[1]; };
    // Rows -4 .. 7; repeat has the period of the texture, mirror turns at its borders.
    EXPECT_EQ(at(Wrap::kRepeat), light_of_srgb(10 * repeat[i + 4]));
    EXPECT_EQ(at(Wrap::kMirror), light_of_srgb(10 * mirror[i + 4]));
    EXPECT_EQ(at(Wrap::kClamp), light_of_srgb(10 * std::min(std::max(i, 0), 3)));
  }
}

TEST(JudgedTexture, BetweenCentresItIsLinear) {
  const JudgedTexture texture = row();
  const WeightedColour at = texture.at(paint(Wrap::kClamp, false), 1.75, 0.3);
  EXPECT_NEAR(at[1], 0.75 * light_of_srgb(10) + 0.25 * light_of_srgb(20), 1e-12);
  EXPECT_NEAR(at[0], 1, 1e-12);
}

TEST(JudgedTexture, WhatIsCutOutWeighsNothing) {
  const WeightedColour at = row(127.5).at(paint(Wrap::kClamp, false), 1.75, 0.3);
  EXPECT_NEAR(at[0], 0.75, 1e-12);
  EXPECT_NEAR(at[2], 0.75 * light_of_srgb(10), 1e-12);
}

}  // namespace
}  // namespace svdag
