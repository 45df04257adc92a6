#include "io/scene/decoders/image.h"

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "io/scene/decoders/limited_decoder.h"
#include "streaming/error.h"

// Without SIMD: the same texels on every machine.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_NO_SIMD
#define STBI_NO_STDIO
#include <stb/stb_image.h>

namespace svdag {
namespace {

// Max bytes that stb_image holds of a texel: an interlaced PNG with 16 bits a channel.
constexpr uint64_t kBytesPerTexel = 28;
constexpr uint64_t kBesideTexels = uint64_t(64) << 20;

struct ImageSize {
  int width = 0, height = 0;
  uint64_t texels() const { return uint64_t(width) * uint64_t(height); }
};

[[noreturn]] void fail(const ImageSource& source) {
  fail_input(source.path,
             std::string("is not a readable PNG or JPEG image: ") + stbi_failure_reason());
}

const stbi_uc* data_of(const ImageSource& source) {
  return reinterpret_cast<const stbi_uc*>(source.bytes.data());
}

ImageSize size_of(const ImageSource& source) {
  ImageSize size;
  int channels = 0;
  if (stbi_info_from_memory(data_of(source), int(source.bytes.size()), &size.width, &size.height,
                            &channels) == 0)
    fail(source);
  return size;
}

struct Texels {
  std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> owned;
  ImageSize size;
  size_t channels;

  std::span<const stbi_uc> all() const { return {owned.get(), size_t(size.texels()) * channels}; }
};

Texels decode(const ImageSource& source) {
  ImageSize size;
  int channels = 0;
  Texels texels{{stbi_load_from_memory(data_of(source), int(source.bytes.size()), &size.width,
                                       &size.height, &channels, 0),
                 &stbi_image_free},
                size,
                size_t(channels)};
  if (!texels.owned) fail(source);
  texels.size = size;
  texels.channels = size_t(channels);
  return texels;
}

// What work() returns in a limited child.
template <class Result>
Result in_child(const ImageSource& source, const DecoderLimits& limits,
                const std::function<Result()>& work) {
  std::optional<Result> result;
  run_decoder(
      limits, source.path, source.sandbox, [&](DecoderOutput& out) { out.send_one(0, work()); },
      [&](const DecoderMessage& message) { result = message.record<Result>(); });
  if (!result) fail_input(source.path, "its decoder sent nothing");
  return *result;
}

}  // namespace

void check_image_bytes(uint64_t bytes, const std::string& path) {
  if (bytes > kMaxImageBytes) fail_input(path, "is an image of more than 1 GiB, which is not read");
}

namespace {

// An image whose head was read, and what its texels need.
struct CheckedImage {
  ImageSize size;
  MemoryBudget::Reservation memory;
  DecoderLimits limits;
};

CheckedImage check_image(const ImageSource& source, MemoryBudget* budget) {
  check_image_bytes(source.bytes.size(), source.path);
  const uint64_t seconds = 30 + source.bytes.size() / 65536;
  const ImageSize size =
      in_child<ImageSize>(source, {kBesideTexels, seconds}, [&] { return size_of(source); });
  const auto is_side = [](int n) { return n > 0 && uint64_t(n) <= kMaxImageSide; };
  if (!is_side(size.width) || !is_side(size.height))
    fail_input(source.path, "is an image of " + std::to_string(size.width) + " x " +
                                std::to_string(size.height) + " texels, more than " +
                                std::to_string(kMaxImageSide) + " a side");
  const uint64_t bytes = kBytesPerTexel * size.texels() + 2 * source.bytes.size();
  return {size,
          budget->reserve(bytes, "texels of a texture"),
          {kBesideTexels + bytes, seconds + (size.texels() >> 20)}};
}

}  // namespace

namespace {

// `convert` writes kBytes bytes for a texel of `channels` bytes.
template <size_t kBytes, class Convert>
std::vector<uint8_t> decoded_bytes(const ImageSource& source, const CheckedImage& image,
                                   const Convert& convert) {
  const uint64_t count = kBytes * image.size.texels();
  std::vector<uint8_t> bytes;
  bytes.reserve(size_t(count));
  run_decoder(
      image.limits, source.path, source.sandbox,
      [&](DecoderOutput& out) {
        const Texels decoded = decode(source);
        std::vector<uint8_t> converted(kBytes * size_t(decoded.size.texels()));
        const stbi_uc* texel = decoded.all().data();
        for (size_t i = 0; i < converted.size(); i += kBytes, texel += decoded.channels)
          convert(texel, decoded.channels, &converted[i]);
        out.send(0, std::span<const uint8_t>(converted));
      },
      [&](const DecoderMessage& message) {
        const auto part = message.records<uint8_t>();
        if (part.size() > count - bytes.size()) message.fail();
        bytes.insert(bytes.end(), part.begin(), part.end());
      });
  if (bytes.size() != count) fail_input(source.path, "its decoder sent too little");
  return bytes;
}

uint8_t alpha_of(const stbi_uc* texel, size_t channels) {
  return channels % 2 == 0 ? texel[channels - 1] : uint8_t(255);
}

void put_colour(const stbi_uc* texel, size_t channels, uint8_t* out) {
  for (size_t c = 0; c < 3; ++c) out[c] = texel[channels < 3 ? 0 : c];
  out[3] = alpha_of(texel, channels);
}

ColourTexels texels_of(const ImageSource& source) {
  const Texels decoded = decode(source);
  ColourTexels texels{decoded.size.width, decoded.size.height,
                      std::vector<uint8_t>(4 * size_t(decoded.size.texels()))};
  const stbi_uc* texel = decoded.all().data();
  for (size_t i = 0; i < texels.rgba.size(); i += 4, texel += decoded.channels)
    put_colour(texel, decoded.channels, &texels.rgba[i]);
  return texels;
}

}  // namespace

AlphaTexels alpha_of_image(const ImageSource& source, MemoryBudget* budget, bool or_luminance) {
  const CheckedImage image = check_image(source, budget);
  const auto convert = [&](const stbi_uc* texel, size_t channels, uint8_t* out) {
    if (channels % 2 == 0 || !or_luminance)
      out[0] = alpha_of(texel, channels);
    else
      out[0] = channels == 1 ? texel[0]
                             : uint8_t((77 * texel[0] + 150 * texel[1] + 29 * texel[2]) / 256);
  };
  return {image.size.width, image.size.height, decoded_bytes<1>(source, image, convert)};
}

ColourTexels colours_of_image(const ImageSource& source, MemoryBudget* budget) {
  const CheckedImage image = check_image(source, budget);
  return {image.size.width, image.size.height, decoded_bytes<4>(source, image, put_colour)};
}

Thumbnail thumbnail_of_image(const ImageSource& source, MemoryBudget* budget,
                             const std::function<Thumbnail(const ColourTexels&)>& reduce) {
  const CheckedImage image = check_image(source, budget);
  enum : uint64_t { kSize, kTexels };
  Thumbnail thumbnail;
  run_decoder(
      image.limits, source.path, source.sandbox,
      [&](DecoderOutput& out) {
        const Thumbnail reduced = reduce(texels_of(source));
        out.send_one(kSize, ImageSize{reduced.width, reduced.height});
        out.send(kTexels, std::span(reduced.texels));
      },
      [&](const DecoderMessage& message) {
        if (message.kind() == kSize) {
          const auto size = message.record<ImageSize>();
          thumbnail = {size.width, size.height, {}};
          return;
        }
        for (const auto& texel : message.records<std::array<uint16_t, 4>>())
          thumbnail.texels.push_back(texel);
        if (thumbnail.texels.size() > kThumbnailSide * kThumbnailSide) message.fail();
      });
  const auto is_side = [](int n) { return n > 0 && n <= kThumbnailSide; };
  if (!is_side(thumbnail.width) || !is_side(thumbnail.height) ||
      thumbnail.texels.size() != size_t(thumbnail.width * thumbnail.height))
    fail_input(source.path, "its decoder sent an invalid block");
  return thumbnail;
}

std::vector<std::byte> bytes_of_image(const File& file, MemoryBudget* budget,
                                      MemoryBudget::Reservation* memory) {
  check_image_bytes(file.size(), file.path());
  *memory = budget->reserve(file.size(), "textures");
  std::vector<std::byte> bytes(size_t(file.size()));
  file.read_at(0, bytes);
  return bytes;
}

}  // namespace svdag
