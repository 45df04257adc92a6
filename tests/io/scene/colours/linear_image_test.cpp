// Textures in linear light, their mip maps, and samples across their borders.
#include "io/scene/colours/linear_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "io/scene/colours/paint.h"

namespace svdag {
namespace {

std::vector<uint8_t> random_texels(int64_t width, int64_t height, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<uint8_t> rgba(size_t(4 * width * height));
  for (size_t i = 0; i < rgba.size(); ++i) rgba[i] = i % 4 == 3 ? 255 : uint8_t(random() & 255);
  return rgba;
}

double sum_of(const LinearImage::Level& level, size_t channel) {
  double sum = 0;
  for (const LinearImage::Texel& texel : level.texels) sum += texel[channel];
  return sum / double(level.width * level.height);
}

TEST(LinearImage, LightIsThatOfTheCode) {
  EXPECT_EQ(light16_of_code(0), 0);
  EXPECT_EQ(light16_of_code(255), kWhite16);
  EXPECT_EQ(light16_of_code(188),
            uint16_t(std::lround(std::pow((188 / 255.0 + 0.055) / 1.055, 2.4) * 65535)));
  EXPECT_EQ(light16(2), kWhite16);
  EXPECT_EQ(light16(-1), 0);
  EXPECT_EQ(light16(std::nan("")), 0);
}

// Odd sides too: a coarser texel has shares of the texels at its border.
TEST(LinearImage, EveryLevelHasTheMeanOfTheImage) {
  for (const auto& [width, height] :
       {std::pair{16, 16}, {1, 7}, {13, 5}, {31, 30}, {3, 3}, {1, 1}}) {
    const LinearImage image(width, height, random_texels(width, height, 5), 0);
    EXPECT_FALSE(image.has_holes());
    const auto& levels = image.levels();
    EXPECT_EQ(levels.back().texels.size(), 1u);
    for (size_t k = 1; k < levels.size(); ++k) {
      EXPECT_EQ(levels[k].width, std::max<int64_t>(1, levels[k - 1].width / 2));
      EXPECT_EQ(levels[k].height, std::max<int64_t>(1, levels[k - 1].height / 2));
      for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(sum_of(levels[k], c), sum_of(levels[0], c), double(k));
      EXPECT_EQ(sum_of(levels[k], 3), kWhite16);
    }
  }
}

TEST(LinearImage, ATexelThatIsCutOutHasNoColour) {
  const LinearImage image(2, 2,
                          {255, 255, 255, 127, 255, 0, 0, 128,  //
                           255, 255, 255, 0, 255, 0, 0, 255},
                          127.5);
  EXPECT_TRUE(image.has_holes());
  const LinearImage::Texel mean = image.levels()[1].texels[0];
  EXPECT_EQ(mean[0], mean[3]);
  EXPECT_EQ(mean[1], 0);
  EXPECT_EQ(mean[3], 32768);
}

TEST(LevelSampler, GoesOnBeyondTheBorderAsTheWrapSays) {
  Paint paint;
  paint.image = std::make_shared<LinearImage>(
      3, 1, std::vector<uint8_t>{0, 0, 0, 255, 255, 0, 0, 255, 0, 255, 0, 255}, 0);
  // Red, as thirds of texels -4 .. 6: 1 at the middle texel.
  const auto red_at = [&](Wrap wrap, bool nearest, double u) {
    paint.wrap_u = wrap;
    return LevelSampler(paint, 0, nearest).at(u, 0.3)[0] / float(kWhite16);
  };
  for (const bool nearest : {false, true}) {
    for (int i = -4; i <= 6; ++i) {
      const int repeated = ((i % 3) + 3) % 3, turn = (i - repeated) / 3;
      EXPECT_EQ(red_at(Wrap::kRepeat, nearest, i + 0.5), repeated == 1 ? 1 : 0);
      EXPECT_EQ(red_at(Wrap::kClamp, nearest, i + 0.5), i == 1 ? 1 : 0);
      const int mirrored = turn % 2 == 0 ? repeated : 2 - repeated;
      EXPECT_EQ(red_at(Wrap::kMirror, nearest, i + 0.5), mirrored == 1 ? 1 : 0);
    }
  }
  EXPECT_EQ(red_at(Wrap::kRepeat, false, 1.25), 0.75F);
  EXPECT_EQ(red_at(Wrap::kRepeat, true, 1.01), 1);
  EXPECT_EQ(red_at(Wrap::kRepeat, true, -1.01), 1);
  // Between the last texel and the first.
  paint.wrap_u = Wrap::kRepeat;
  EXPECT_EQ(LevelSampler(paint, 0, false).at(0, 0.5)[1], kWhite16 / 2.0F);
  paint.wrap_u = Wrap::kClamp;
  EXPECT_EQ(LevelSampler(paint, 0, false).at(0, 0.5)[1], 0);
  EXPECT_EQ(LevelSampler(paint, 0, false).at(0x1p39, -0x1p39)[1], kWhite16);
}

}  // namespace
}  // namespace svdag
