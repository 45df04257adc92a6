// The textures that colour a scene, each decoded once for all passes over it.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "io/scene/colours/linear_image.h"
#include "io/scene/cutouts/alpha_image.h"

namespace svdag {

class LinearImages {
 public:
  // Returns the bytes of an image, reserved in *memory.
  using Read = std::function<std::vector<std::byte>(MemoryBudget::Reservation* memory)>;

  enum class Detail {
    kThumbnails,  // of at most kThumbnailSide texels a side: enough for means
    kWhole,
    kKept  // whole, with LinearImage::encoded()
  };

  LinearImages(MemoryBudget* budget, bool sandbox, Detail detail)
      : budget_(budget), sandbox_(sandbox), detail_(detail) {}

  // The image `name`, which is unique to it, with the texels below `threshold` cut out; read() is
  // called the first time. Null, and a note, for one that cannot be read: the triangles have the
  // colour of their material without it.
  // `mask`: another image, whose alpha at the centre of a texel counts instead of the texel's,
  // except in thumbnails.
  std::shared_ptr<const LinearImage> image(const std::string& name, double threshold,
                                           const Read& read,
                                           std::shared_ptr<const AlphaImage> mask = nullptr);
  // Of an image file.
  std::shared_ptr<const LinearImage> image_of_file(
      const std::string& path, double threshold, std::shared_ptr<const AlphaImage> mask = nullptr);

  MemoryBudget* budget() const { return budget_; }
  // "PATH: what is wrong", of each image that cannot be read and each note.
  const std::vector<std::string>& notes() const { return notes_; }
  // Adds one, once.
  void note(const std::string& text);

 private:
  std::shared_ptr<const LinearImage> decode(const std::string& name, double threshold,
                                            const Read& read,
                                            const std::shared_ptr<const AlphaImage>& mask) const;

  MemoryBudget* budget_;
  bool sandbox_;
  Detail detail_;
  using Key = std::tuple<std::string, double, std::shared_ptr<const AlphaImage>>;
  std::map<Key, std::shared_ptr<const LinearImage>> images_;
  std::vector<std::string> notes_;
};

}  // namespace svdag
