// Images reduced to their mean colour, against means in long double; damaged and hostile images.
#include "io/scene/decoders/image.h"

#include <gtest/gtest.h>

#include <random>

#include "io/colour.h"
#include "io/scene/colours/linear_image.h"
#include "tests/expect_error.h"
#include "tests/io/scene/png_file.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace svdag {
namespace {

// Of RGB texels.
std::string jpeg(int width, int height, const std::string& texels) {
  std::string bytes;
  const auto append = [](void* out, void* data, int size) {
    static_cast<std::string*>(out)->append(static_cast<const char*>(data), size_t(size));
  };
  stbi_write_jpg_to_func(append, &bytes, width, height, 3, texels.data(), 100);
  return bytes;
}

// Of what is not transparent, from a small image.
LinearColour mean(const std::string& image, bool sandbox = false) {
  MemoryBudget budget;
  const auto by_alpha = [](const ColourTexels& texels) {
    const LinearImage whole(texels.width, texels.height, texels.rgba, 1);
    const LinearImage::Level& level = whole.levels().back();
    return Thumbnail{int(level.width), int(level.height), level.texels};
  };
  const Thumbnail small =
      thumbnail_of_image({std::as_bytes(std::span(image)), "a.png", sandbox}, &budget, by_alpha);
  EXPECT_EQ(budget.used(), 0u);
  EXPECT_GT(budget.peak(), 0u);
  LinearColour light;
  const auto& texel = small.texels[0];
  for (size_t c = 0; c < 3; ++c)
    light.units[c] = light_units(double(texel[c]) / std::max<int>(texel[3], 1));
  return light;
}

Colour colour(const std::string& image) {
  return mean(image).times({1, 1, 1});
}

long double exact_light(int code) {
  const long double v = code / 255.0L;
  return v <= 0.04045L ? v / 12.92L : std::pow((v + 0.055L) / 1.055L, 2.4L);
}

TEST(Image, TheMeanIsThatOfLinearLight) {
  EXPECT_EQ(colour(png(1, 1, PngKind::kRgb, rgb(12, 200, 255))), (Colour{12, 200, 255}));
  // Half of full light is code 188, not 128.
  EXPECT_EQ(colour(png(2, 1, PngKind::kRgb, rgb(0, 0, 255) + rgb(255, 0, 255))),
            (Colour{188, 0, 255}));
}

TEST(Image, RandomTexelsThatAreNotTransparentHaveTheirExactMean) {
  std::mt19937 random(1);
  for (const bool alpha : {false, true}) {
    const size_t channels = alpha ? 4 : 3;
    std::string texels(37 * 41 * channels, '\0');
    for (char& c : texels) c = char(random());
    std::array<long double, 3> sums{};
    long double whole = 0;
    for (size_t i = 0; i < texels.size(); i += channels) {
      const long double weight = alpha ? (texels[i + 3] != 0) : 1;
      for (size_t c = 0; c < 3; ++c) sums[c] += weight * exact_light(uint8_t(texels[i + c]));
      whole += weight;
    }
    const std::string image = png(37, 41, alpha ? PngKind::kRgba : PngKind::kRgb, texels);
    const LinearColour light = mean(image);
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(double(light.units[c]), double(sums[c] / whole * double(kWhiteUnits)),
                  2 * kWhiteUnits / 65535.0);
    EXPECT_EQ(mean(image, true).units, light.units) << "in the sandbox";
  }
}

TEST(Image, TransparentTexelsHaveNoSay) {
  const std::string red = rgb(255, 0, 0), green = rgb(0, 255, 0);
  EXPECT_EQ(colour(png(2, 1, PngKind::kRgba, red + '\xff' + green + '\0')), (Colour{255, 0, 0}));
}

TEST(Image, EveryKindOfPng) {
  EXPECT_EQ(colour(png(1, 1, PngKind::kGrey, "\x40")), (Colour{64, 64, 64}));
  EXPECT_EQ(colour(png(2, 1, PngKind::kGreyAlpha, std::string("\x40\xff\x80\x00", 4))),
            (Colour{64, 64, 64}));
  EXPECT_EQ(colour(png(8, 1, PngKind::kGrey, "\xf0", 1)), (Colour{188, 188, 188}));
  EXPECT_EQ(colour(png(1, 1, PngKind::kRgb, "\x40\xff\x80\x01\x01\xff", 16)), (Colour{64, 128, 1}));
  const std::string palette = png_chunk("PLTE", rgb(9, 8, 7) + rgb(1, 2, 3));
  EXPECT_EQ(colour(png(1, 1, PngKind::kPalette, "\x01", 8, palette)), (Colour{1, 2, 3}));
  const std::string clear = palette + png_chunk("tRNS", std::string("\xff\0", 2));
  EXPECT_EQ(colour(png(2, 1, PngKind::kPalette, std::string("\0\1", 2), 8, clear)),
            (Colour{9, 8, 7}));
}

TEST(Image, Jpeg) {
  std::string texels;
  for (int i = 0; i < 24 * 20; ++i) texels += rgb(200, 100, 50);
  const Colour c = colour(jpeg(24, 20, texels));
  EXPECT_NEAR(c.r, 200, 2);
  EXPECT_NEAR(c.g, 100, 2);
  EXPECT_NEAR(c.b, 50, 2);
}

TEST(Image, OtherFilesAreBadInput) {
  for (const std::string& image :
       {std::string(), std::string("\xabKTX 20\xbb\r\n\x1a\n"), std::string("GIF89a\1\0\1\0", 10),
        std::string("RIFF\x24\0\0\0WEBPVP8 ", 16), std::string("P6 1 1 255 abc")})
    EXPECT_SVDAG_ERROR(mean(image), ExitCode::kBadInput, "a.png: is not a readable PNG or JPEG");
}

TEST(Image, LargeImagesAreNotDecoded) {
  EXPECT_EQ(colour(png(kMaxImageSide, 1, PngKind::kGrey, std::string(kMaxImageSide, '\x40'))),
            (Colour{64, 64, 64}));
  EXPECT_SVDAG_ERROR(mean(png(kMaxImageSide + 1, 1, PngKind::kGrey, "\x40")), ExitCode::kBadInput,
                     "is an image of 16385 x 1 texels, more than 16384 a side");
  EXPECT_SVDAG_ERROR(check_image_bytes(kMaxImageBytes + 1, "a.png"), ExitCode::kBadInput,
                     "a.png: is an image of more than 1 GiB");
}

TEST(Image, ASmallBudgetIsAnErrorAndNotAnotherColour) {
  const std::string image = png(256, 256, PngKind::kGrey, std::string(65536, '\x40'));
  MemoryBudget budget(1 << 20);
  EXPECT_SVDAG_ERROR(colours_of_image({std::as_bytes(std::span(image)), "a.png"}, &budget),
                     ExitCode::kMemory, "raise --memory");
}

// Whatever the decoder does with it: a mean, or bad input.
TEST(Image, DamagedImagesAreBadInputAtMost) {
  std::string texels;
  for (int i = 0; i < 16 * 16; ++i) texels += rgb(i, 3 * i, 7 * i);
  std::mt19937 random(2);
  int read = 0, refused = 0;
  for (const std::string& image : {png(16, 16, PngKind::kRgb, texels), jpeg(16, 16, texels)}) {
    for (int i = 0; i < 60; ++i) {
      std::string damaged = image;
      if (i % 3 == 0) damaged.resize(random() % image.size());
      for (int n = i % 3; n > 0; --n) damaged[random() % image.size()] = char(random());
      try {
        mean(damaged, i % 2 == 0);
        ++read;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
        ++refused;
      }
    }
  }
  EXPECT_GT(read, 10);
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace svdag
