#include "io/scene/colours/linear_images.h"

#include <algorithm>

#include "io/scene/decoders/image.h"
#include "streaming/error.h"

namespace svdag {

std::shared_ptr<const LinearImage> LinearImages::image(const std::string& name, double threshold,
                                                       const Read& read) {
  const auto [known, is_new] = images_.try_emplace({name, threshold});
  if (!is_new) return known->second;
  try {
    MemoryBudget::Reservation memory;
    std::vector<std::byte> bytes = read(&memory);
    const ColourTexels texels = colours_of_image({bytes, name, sandbox_}, budget_);
    const auto decoded = budget_->reserve(texels.rgba.size(), "a decoded texture");
    auto held = budget_->reserve(LinearImage::bytes(texels.rgba.size() / 4), "textures");
    const auto image = std::make_shared<LinearImage>(texels.width, texels.height, texels.rgba,
                                                     threshold, std::move(held));
    if (keep_) image->keep({name, std::move(bytes), threshold, std::move(memory)});
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
