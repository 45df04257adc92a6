// The texels of a PNG or JPEG image, their alpha or their mean colour. Only image.cpp uses the
// stb_image library.
//
// The image is decoded in a limited child process: first its head, then, in memory that depends
// only on its size, its texels. So a smaller budget is an Error or makes no difference. Rejected:
// libpng and libjpeg, which would decode line by line, but whose versions differ in the colours of
// a JPEG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/colour.h"
#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

struct ImageSource {
  std::span<const std::byte> bytes;
  std::string path;      // for errors
  bool sandbox = false;  // with a system call filter
};

constexpr uint64_t kMaxImageSide = 16384;               // in texels
constexpr uint64_t kMaxImageBytes = uint64_t(1) << 30;  // of the file

// Error (kBadInput) if a file of `bytes` is too large for an image.
void check_image_bytes(uint64_t bytes, const std::string& path);

// The bytes of an image file, reserved in *memory.
std::vector<std::byte> bytes_of_image(const File& file, MemoryBudget* budget,
                                      MemoryBudget::Reservation* memory);

// Means of the texels of an image in linear light.
struct ImageMean {
  LinearColour visible;  // weighted by alpha, unless that is zero everywhere
  LinearColour all;      // for materials that ignore alpha
};

// Of 16 bits a channel, the upper eight count. An image that is broken, too large or of another
// format is an Error (kBadInput).
ImageMean mean_of_image(const ImageSource& source, MemoryBudget* budget);

// The alpha of the texels, row by row from the top; in an image without alpha their luminance
// (77 R + 150 G + 29 B) / 256 if `or_luminance`, else 255.
struct AlphaTexels {
  int width = 0, height = 0;
  std::vector<uint8_t> alpha;
};
// Errors as above.
AlphaTexels alpha_of_image(const ImageSource& source, MemoryBudget* budget,
                           bool or_luminance = false);

// The texels, row by row from the top: red, green and blue in sRGB, and alpha (255 in an image
// without).
struct ColourTexels {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;
};
// Errors as above. The caller reserves the texels, 4 bytes each.
ColourTexels colours_of_image(const ImageSource& source, MemoryBudget* budget);

// The mean colours of the images that materials name. Each image is read once, for all passes over
// a scene.
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

  MemoryBudget* budget() const { return budget_; }
  // Number of images so far.
  size_t size() const { return means_.size(); }
  // "PATH: what is wrong", of each image without a mean and each file that was left out.
  const std::vector<std::string>& notes() const { return notes_; }
  // Adds one, once.
  void note(const std::string& text);

 private:
  MemoryBudget* budget_;
  bool sandbox_;
  std::map<std::string, std::optional<ImageMean>> means_;
  std::vector<std::string> notes_;
};

}  // namespace svdag
