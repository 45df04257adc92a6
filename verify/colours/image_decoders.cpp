#include "verify/colours/image_decoders.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>

// Needs size_t and FILE.
#include <jpeglib.h>
#include <png.h>

#include "io/scene/decoders/limited_decoder.h"
#include "streaming/error.h"

namespace svdag {
namespace {

struct Picture {
  const EncodedImage* image;
  uint32_t width, height;
  std::vector<uint8_t> rgba;
  std::vector<png_bytep> rows;

  const JOCTET* bytes() const { return reinterpret_cast<const JOCTET*>(image->bytes.data()); }
};

struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf back;
};

[[noreturn]] void leave_jpeg(j_common_ptr info) {
  std::longjmp(reinterpret_cast<JpegErrors*>(info->err)->back, 1);
}

// The libraries return from errors by longjmp(): no object with a destructor is made between.
bool decode_jpeg(Picture* picture) {
  jpeg_decompress_struct info;
  JpegErrors errors;
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = leave_jpeg;
  errors.base.output_message = [](j_common_ptr) {};
  jpeg_create_decompress(&info);
  if (setjmp(errors.back) != 0) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_mem_src(&info, picture->bytes(), static_cast<unsigned long>(picture->image->bytes.size()));
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&info);
  const bool fits = info.output_width == picture->width && info.output_height == picture->height;
  while (fits && info.output_scanline < info.output_height)
    jpeg_read_scanlines(&info, &picture->rows[info.output_scanline], 1);
  jpeg_destroy_decompress(&info);
  return fits;
}

struct PngInput {
  const EncodedImage* image;
  size_t at;
};

void read_png_bytes(png_structp png, png_bytep out, size_t count) {
  auto* const input = static_cast<PngInput*>(png_get_io_ptr(png));
  if (count > input->image->bytes.size() - input->at) png_error(png, "ends early");
  std::memcpy(out, input->image->bytes.data() + input->at, count);
  input->at += count;
}

// Gamma and profiles of the file are ignored, as glTF wants it.
bool decode_png(Picture* picture) {
  png_structp png = png_create_read_struct(
      PNG_LIBPNG_VER_STRING, nullptr, [](png_structp p, png_const_charp) { png_longjmp(p, 1); },
      [](png_structp, png_const_charp) {});
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  PngInput input{picture->image, 0};
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_read_fn(png, &input, read_png_bytes);
  png_read_info(png, info);
  png_set_expand(png);
  png_set_strip_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  const bool fits = png_get_image_width(png, info) == picture->width &&
                    png_get_image_height(png, info) == picture->height &&
                    png_get_rowbytes(png, info) == 4 * size_t(picture->width);
  if (fits) png_read_image(png, picture->rows.data());
  png_destroy_read_struct(&png, &info, nullptr);
  return fits;
}

}  // namespace

std::vector<uint8_t> judged_texels(const EncodedImage& image, int64_t width, int64_t height,
                                   bool sandbox) {
  constexpr uint64_t kBeside = uint64_t(64) << 20;
  const uint64_t count = 4 * uint64_t(width) * uint64_t(height);
  std::vector<uint8_t> texels;
  texels.reserve(size_t(count));
  run_decoder(
      {kBeside + 8 * count, 30 + image.bytes.size() / 65536 + (count >> 22)}, image.name, sandbox,
      [&](DecoderOutput& out) {
        Picture picture{&image, uint32_t(width), uint32_t(height), {}, {}};
        picture.rgba.resize(size_t(count));
        for (int64_t j = 0; j < height; ++j)
          picture.rows.push_back(&picture.rgba[size_t(4 * j * width)]);
        if (is_jpeg(image) ? decode_jpeg(&picture) : decode_png(&picture))
          out.send(0, std::span<const uint8_t>(picture.rgba));
      },
      [&](const DecoderMessage& message) {
        const auto part = message.records<uint8_t>();
        if (part.size() > count - texels.size()) message.fail();
        texels.insert(texels.end(), part.begin(), part.end());
      });
  if (texels.size() != count)
    fail_input(image.name, "is not an image of " + std::to_string(width) + " x " +
                               std::to_string(height) + " texels for libpng and libjpeg-turbo");
  return texels;
}

}  // namespace svdag
