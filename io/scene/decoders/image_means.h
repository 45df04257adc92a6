// The mean colours of the images that materials name. Each image is read once, for all passes over
// a scene.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/scene/decoders/image.h"
#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class ImageMeans {
 public:
  // Returns the bytes of an image, reserved in *memory.
  using Read = std::function<std::vector<std::byte>(MemoryBudget::Reservation* memory)>;

  ImageMeans(MemoryBudget* budget, bool sandbox) : budget_(budget), sandbox_(sandbox) {}

  // The mean of the image `name`, which is unique to it. read() is called the first time. An Error
  // (kBadInput) of it, or an image that cannot be used, gives no mean and a note.
  std::optional<ImageMean> mean(const std::string& name, const Read& read);
  // Of an image file.
  std::optional<ImageMean> mean_of_file(const std::string& path);
  // The bytes of an image file.
  std::vector<std::byte> bytes_of(const File& file, MemoryBudget::Reservation* memory) const;

  MemoryBudget* budget() const { return budget_; }
  // "PATH: what is wrong", of each image without a mean.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  MemoryBudget* budget_;
  bool sandbox_;
  std::map<std::string, std::optional<ImageMean>> means_;
  std::vector<std::string> notes_;
};

}  // namespace svdag
