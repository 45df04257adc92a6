#include "io/scene/colours/linear_images.h"

#include <algorithm>

#include "io/scene/decoders/image.h"
#include "streaming/error.h"

namespace svdag {
namespace {

void set_alpha(const AlphaImage& mask, ColourTexels* texels) {
  const auto middle = [](int64_t i, int64_t from, int64_t to) {
    return (2 * i + 1) * to / (2 * from);
  };
  size_t at = 3;
  for (int64_t j = 0; j < texels->height; ++j) {
    for (int64_t i = 0; i < texels->width; ++i, at += 4)
      texels->rgba[at] =
          mask.at(middle(i, texels->width, mask.width()), middle(j, texels->height, mask.height()));
  }
}

LinearImage::Level thumbnail(const ColourTexels& texels, double threshold) {
  const LinearImage image(texels.width, texels.height, texels.rgba, threshold);
  return *std::ranges::find_if(image.levels(), [](const LinearImage::Level& level) {
    return std::max(level.width, level.height) <= kThumbnailSide;
  });
}

}  // namespace

std::shared_ptr<const LinearImage> LinearImages::decode(
    const std::string& name, double threshold, const Read& read,
    const std::shared_ptr<const AlphaImage>& mask) const {
  MemoryBudget::Reservation memory;
  std::vector<std::byte> bytes = read(&memory);
  if (detail_ == Detail::kThumbnails) {
    Thumbnail small =
        thumbnail_of_image({bytes, name, sandbox_}, budget_, [&](const ColourTexels& texels) {
          LinearImage::Level level = thumbnail(texels, threshold);
          return Thumbnail{int(level.width), int(level.height), std::move(level.texels)};
        });
    return std::make_shared<LinearImage>(
        LinearImage::Level{small.width, small.height, std::move(small.texels)},
        budget_->reserve(LinearImage::bytes(small.texels.size()), "small textures"));
  }
  ColourTexels texels = colours_of_image({bytes, name, sandbox_}, budget_);
  const auto decoded = budget_->reserve(texels.rgba.size(), "a decoded texture");
  if (mask) set_alpha(*mask, &texels);
  auto held = budget_->reserve(LinearImage::bytes(texels.rgba.size() / 4), "textures");
  const auto image = std::make_shared<LinearImage>(texels.width, texels.height, texels.rgba,
                                                   threshold, std::move(held));
  if (detail_ == Detail::kKept)
    image->keep({name, std::move(bytes), threshold, mask, std::move(memory)});
  return image;
}

std::shared_ptr<const LinearImage> LinearImages::image(const std::string& name, double threshold,
                                                       const Read& read,
                                                       std::shared_ptr<const AlphaImage> mask) {
  const auto [known, is_new] = images_.try_emplace({name, threshold, mask});
  if (!is_new) return known->second;
  try {
    known->second = decode(name, threshold, read, mask);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    note(error.what());
  }
  return known->second;
}

std::shared_ptr<const LinearImage> LinearImages::image_of_file(
    const std::string& path, double threshold, std::shared_ptr<const AlphaImage> mask) {
  const auto read = [&](MemoryBudget::Reservation* memory) {
    return bytes_of_image(File::open_read(path), budget_, memory);
  };
  return image(path, threshold, read, std::move(mask));
}

void LinearImages::note(const std::string& text) {
  if (std::ranges::find(notes_, text) == notes_.end()) notes_.push_back(text);
}

}  // namespace svdag
