// The mean of the part of a texture that triangles use.
#include "io/scene/colours/used_mean.h"

#include <gtest/gtest.h>

#include <random>

namespace svdag {
namespace {

constexpr int64_t kTexels = 64;

// Columns 0 .. 31 are black, the others white; the lower half of the white ones is cut out.
Paint halves() {
  std::vector<uint8_t> rgba;
  for (int64_t j = 0; j < kTexels; ++j) {
    for (int64_t i = 0; i < kTexels; ++i) {
      const uint8_t code = i < kTexels / 2 ? 0 : 255;
      rgba.insert(rgba.end(), {code, code, code, uint8_t(code != 0 && j >= kTexels / 2 ? 0 : 255)});
    }
  }
  return {std::make_shared<LinearImage>(kTexels, kTexels, rgba, 128)};
}

double red(const UsedMean& mean) {
  return double(mean.mean()->units[0]) / double(kWhiteUnits);
}

TEST(UsedMean, OfOneHalfIsItsColour) {
  UsedMean black(halves()), white(halves());
  black.add({{{2, 2}, {28, 2}, {2, 28}}});
  white.add({{{36, 2}, {60, 2}, {36, 28}}});
  EXPECT_NEAR(red(black), 0, 1e-4);
  EXPECT_NEAR(red(white), 1, 1e-4);
}

TEST(UsedMean, TrianglesCountByTheirAreaInTheTexture) {
  UsedMean mean(halves());
  mean.add({{{2, 2}, {28, 2}, {2, 28}}});      // 338 black texels
  mean.add({{{40, 4}, {53, 4}, {40, 17}}});    // 84.5 white ones
  mean.add({{{60, 10}, {60, 10}, {60, 10}}});  // a point
  EXPECT_NEAR(red(mean), 0.2, 1e-3);
}

TEST(UsedMean, OfPointsAloneIsTheirMean) {
  UsedMean mean(halves());
  mean.add({{{10, 10}, {10, 10}, {10, 10}}});
  mean.add({{{50, 10}, {50, 10}, {50, 10}}});
  EXPECT_NEAR(red(mean), 0.5, 1e-3);
}

TEST(UsedMean, WithoutOpaqueTrianglesIsThatOfTheImage) {
  UsedMean none(halves()), cut(halves()), lost(halves());
  cut.add({{{40, 40}, {60, 40}, {40, 60}}});
  lost.add({{{0, 0}, {0x1p50, 0}, {0, 1}}});
  for (const UsedMean* mean : {&none, &cut, &lost}) EXPECT_NEAR(red(*mean), 1.0 / 3, 1e-3);
  const std::vector<uint8_t> clear(4);
  EXPECT_FALSE(UsedMean({std::make_shared<LinearImage>(1, 1, clear, 1)}).mean());
}

TEST(UsedMean, DoesNotDependOnTheOrderOfTrianglesAndCorners) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-100, 200);
  std::vector<TextureCorners> all(50);
  for (TextureCorners& t : all)
    for (TexturePoint& p : t) p = {place(random), place(random)};
  UsedMean first(halves());
  for (const TextureCorners& t : all) first.add(t);
  std::ranges::shuffle(all, random);
  UsedMean second(halves());
  for (const TextureCorners& t : all) second.add({t[2], t[0], t[1]});
  EXPECT_EQ(first.mean()->units, second.mean()->units);
}

}  // namespace
}  // namespace svdag
