// Streams the elements of a glTF accessor through a small window, sparse replacements included.
//
// Components become double without rounding; normalised integers c become c / max, at least -1
// (KHR_mesh_quantization), in one division. A sparse accessor's indices increase strictly, so its
// replacements are merged on the way and nothing is held.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "io/scene/gltf/document/gltf_buffers.h"
#include "io/triangle.h"

namespace svdag {

static_assert(sizeof(Point) == 3 * sizeof(double));
inline std::span<double> as_numbers(std::span<Point> points) {
  return {reinterpret_cast<double*>(points.data()), points.size() * 3};
}

// Reads the elements of an accessor in order.
class ElementStream {
 public:
  explicit ElementStream(const Accessor& accessor);

  // The next elements as doubles or (integers only) uint32, at most out.size() / components;
  // returns the number of elements read.
  template <class T>
  size_t read(std::span<T> out);

  static constexpr size_t kWindow = size_t(1) << 16;  // bytes

 private:
  explicit ElementStream(const ElementArray& array, const std::string* path);
  void refill();
  template <class T>
  void decode(size_t n, T* out);
  template <class T>
  void replace(uint64_t first, size_t n, T* out);
  void next_replacement();

  ElementArray array_;
  const std::string* path_;
  uint64_t position_ = 0;   // next element
  uint64_t in_window_ = 0;  // elements left in the window, which begins at cursor_
  size_t cursor_ = 0;
  size_t window_bytes_ = 0;
  std::unique_ptr<std::byte[]> window_;
  std::unique_ptr<ElementStream> indices_;
  std::unique_ptr<ElementStream> values_;
  std::optional<uint64_t> replacement_;  // the next element that is replaced
};

}  // namespace svdag
