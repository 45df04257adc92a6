// The alpha of the images that cut materials, each decoded once, for all passes over a scene.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/scene/cutouts/alpha_image.h"
#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class AlphaImages {
 public:
  // Returns the bytes of an image, reserved in *memory.
  using Read = std::function<std::vector<std::byte>(MemoryBudget::Reservation* memory)>;

  AlphaImages(MemoryBudget* budget, bool sandbox) : budget_(budget), sandbox_(sandbox) {}

  // The image `name`, which is unique to it; read() is called the first time. It decides voxels, so
  // one that cannot be read is an Error (kBadInput).
  // `or_luminance`: in place of the alpha, if the image has none.
  std::shared_ptr<const AlphaImage> image(const std::string& name, const Read& read,
                                          bool or_luminance = false);
  // One texel of alpha 255.
  std::shared_ptr<const AlphaImage> opaque();

  MemoryBudget* budget() const { return budget_; }

 private:
  MemoryBudget* budget_;
  bool sandbox_;
  std::map<std::pair<std::string, bool>, std::shared_ptr<const AlphaImage>> images_;
};

}  // namespace svdag
