// The judge's decoders of images give the texels of every kind of PNG, and refuse what is broken.
#include "verify/colours/image_decoders.h"

#include <gtest/gtest.h>

#include "tests/expect_error.h"
#include "tests/io/scene/png_file.h"

namespace svdag {
namespace {

#ifdef SVDAG_HAS_IMAGE_DECODERS

std::vector<uint8_t> texels(const std::string& file, int64_t width, int64_t height) {
  EncodedImage image{"a.png", {}, 0, {}};
  for (const char c : file) image.bytes.push_back(std::byte(c));
  const std::vector<uint8_t> plain = judged_texels(image, width, height, false);
  EXPECT_EQ(plain, judged_texels(image, width, height, true)) << "in a sandbox";
  return plain;
}
using Texels = std::vector<uint8_t>;

TEST(ImageDecoders, EveryKindOfPngBecomesFourChannels) {
  const std::string bytes = {1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(texels(png(2, 1, PngKind::kRgba, bytes), 2, 1), (Texels{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(texels(png(1, 2, PngKind::kRgb, bytes.substr(0, 6)), 1, 2),
            (Texels{1, 2, 3, 255, 4, 5, 6, 255}));
  EXPECT_EQ(texels(png(2, 1, PngKind::kGrey, bytes.substr(0, 2)), 2, 1),
            (Texels{1, 1, 1, 255, 2, 2, 2, 255}));
  EXPECT_EQ(texels(png(2, 1, PngKind::kGreyAlpha, bytes.substr(0, 4)), 2, 1),
            (Texels{1, 1, 1, 2, 3, 3, 3, 4}));
  // Of 16 bits, the upper eight.
  EXPECT_EQ(texels(png(1, 1, PngKind::kRgba, bytes, 16), 1, 1), (Texels{1, 3, 5, 7}));
  EXPECT_EQ(texels(png(2, 1, PngKind::kPalette, std::string("\1\0", 2), 8,
                       png_chunk("PLTE", bytes.substr(0, 6)) + png_chunk("tRNS", "\x80")),
                   2, 1),
            (Texels{4, 5, 6, 255, 1, 2, 3, 128}));
}

TEST(ImageDecoders, GammaOfAPngIsIgnored) {
  EXPECT_EQ(texels(png(1, 1, PngKind::kRgb, "abc", 8, png_chunk("gAMA", big_endian(100000))), 1, 1),
            (Texels{'a', 'b', 'c', 255}));
}

// Baseline, 8 x 8, one component, tables of one code each: all coefficients are 0.
std::string grey_jpeg() {
  std::string bytes = std::string("\xff\xd8\xff\xdb\0\x43\0", 7) + std::string(64, 1) +
                      std::string("\xff\xc0\0\x0b\x08\0\x08\0\x08\1\1\x11\0", 13);
  for (const char table : {'\0', '\x10'})
    bytes += std::string("\xff\xc4\0\x14", 4) + table + '\1' + std::string(16, 0);
  return bytes + std::string("\xff\xda\0\x08\1\1\0\0\x3f\0\x3f\xff\xd9", 13);
}

TEST(ImageDecoders, JpegIsRead) {
  Texels expected;
  for (int i = 0; i < 64; ++i) expected.insert(expected.end(), {128, 128, 128, 255});
  EXPECT_EQ(texels(grey_jpeg(), 8, 8), expected);
}

TEST(ImageDecoders, WhatIsBrokenOrOfAnotherSizeIsRefused) {
  const std::string file = png(2, 1, PngKind::kRgb, "abcdef");
  for (const std::string& broken :
       {std::string(), file.substr(0, 30), file.substr(0, file.size() / 2),
        grey_jpeg().substr(0, 90), std::string("neither")})
    EXPECT_SVDAG_ERROR(texels(broken, 2, 1), ExitCode::kBadInput, "is not an image of 2 x 1");
  EXPECT_SVDAG_ERROR(texels(file, 1, 2), ExitCode::kBadInput, "is not an image of 1 x 2");
  EXPECT_SVDAG_ERROR(texels(grey_jpeg(), 8, 4), ExitCode::kBadInput, "is not an image of 8 x 4");
}

#endif

}  // namespace
}  // namespace svdag
