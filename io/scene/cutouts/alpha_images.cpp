#include "io/scene/cutouts/alpha_images.h"

#include "io/scene/decoders/image.h"
#include "streaming/error.h"

namespace svdag {

std::shared_ptr<const AlphaImage> AlphaImages::image(const std::string& name, const Read& read,
                                                     bool or_luminance) {
  const auto found = images_.find({name, or_luminance});
  if (found != images_.end()) return found->second;
  try {
    MemoryBudget::Reservation memory;
    const std::vector<std::byte> bytes = read(&memory);
    AlphaTexels texels = alpha_of_image({bytes, name, sandbox_}, budget_, or_luminance);
    auto held =
        budget_->reserve(AlphaImage::bytes(texels.width, texels.height), "alpha of a texture");
    return images_[{name, or_luminance}] = std::make_shared<AlphaImage>(
               texels.width, texels.height, std::move(texels.alpha), std::move(held));
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput && error.code() != ExitCode::kOutput) throw;
    throw error.with_hint("; --no-cutouts bakes the material whole");
  }
}

std::shared_ptr<const AlphaImage> AlphaImages::opaque() {
  auto& image = images_[{"", false}];
  if (!image) image = std::make_shared<AlphaImage>(1, 1, std::vector<uint8_t>{255});
  return image;
}

}  // namespace svdag
