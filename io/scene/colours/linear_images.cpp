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

}  // namespace

std::shared_ptr<const LinearImage> LinearImages::image(const std::string& name, double threshold,
                                                       const Read& read,
                                                       std::shared_ptr<const AlphaImage> mask) {
  const auto [known, is_new] = images_.try_emplace({name, threshold, mask});
  if (!is_new) return known->second;
  try {
    MemoryBudget::Reservation memory;
    std::vector<std::byte> bytes = read(&memory);
    ColourTexels texels = colours_of_image({bytes, name, sandbox_}, budget_);
    const auto decoded = budget_->reserve(texels.rgba.size(), "a decoded texture");
    if (mask) set_alpha(*mask, &texels);
    auto held = budget_->reserve(LinearImage::bytes(texels.rgba.size() / 4), "textures");
    const auto image = std::make_shared<LinearImage>(texels.width, texels.height, texels.rgba,
                                                     threshold, std::move(held));
    if (keep_) image->keep({name, std::move(bytes), threshold, mask, std::move(memory)});
    known->second = image;
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    note(error.what());
  }
  return known->second;
}

void LinearImages::note(const std::string& text) {
  if (std::ranges::find(notes_, text) == notes_.end()) notes_.push_back(text);
}

}  // namespace svdag
