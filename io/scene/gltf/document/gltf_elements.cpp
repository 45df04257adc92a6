#include "io/scene/gltf/document/gltf_elements.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "streaming/error.h"

namespace svdag {
namespace {

template <class Source, class T>
T convert(const std::byte* at, bool normalized) {
  Source value;
  std::memcpy(&value, at, sizeof value);  // glTF is little-endian, and so are we
  if constexpr (std::is_integral_v<Source> && std::is_same_v<T, double>) {
    if (normalized) return std::max(value / double(std::numeric_limits<Source>::max()), -1.0);
  }
  return T(value);
}

template <class Source, uint32_t kComponents, class T>
void convert_elements(const ElementArray& array, const std::byte* in, size_t n, T* out) {
  const uint64_t stride = array.stride;
  const bool normalized = array.normalized;
  for (size_t i = 0; i < n; ++i, in += stride, out += kComponents) {
    for (uint32_t c = 0; c < kComponents; ++c) {
      out[c] = convert<Source, T>(in + c * sizeof(Source), normalized);
    }
  }
}

// The loop above with a known number of components: SCALAR, VEC2, VEC3, VEC4 (and MAT2),
// MAT4.
template <class Source, class T>
void convert_all(const ElementArray& array, const std::byte* in, size_t n, T* out) {
  switch (array.components) {
    case 1:
      return convert_elements<Source, 1>(array, in, n, out);
    case 2:
      return convert_elements<Source, 2>(array, in, n, out);
    case 3:
      return convert_elements<Source, 3>(array, in, n, out);
    case 16:
      return convert_elements<Source, 16>(array, in, n, out);
    default:
      return convert_elements<Source, 4>(array, in, n, out);
  }
}

}  // namespace

ElementStream::ElementStream(const ElementArray& array, const std::string* path)
    : array_(array), path_(path) {}

ElementStream::ElementStream(const Accessor& accessor)
    : ElementStream(accessor.base, accessor.path) {
  if (!accessor.sparse_indices) return;
  indices_.reset(new ElementStream(*accessor.sparse_indices, path_));
  values_.reset(new ElementStream(accessor.sparse_values, path_));
  next_replacement();
}

// Fills the window with the elements from position_ on.
void ElementStream::refill() {
  const uint64_t left = array_.count - position_;
  const uint64_t fit = std::max<uint64_t>(1, kWindow / array_.stride);
  in_window_ = std::min(left, fit);
  const size_t bytes = size_t((in_window_ - 1) * array_.stride + array_.element_bytes());
  if (bytes > window_bytes_) {
    window_ = std::make_unique_for_overwrite<std::byte[]>(bytes);
    window_bytes_ = bytes;
  }
  array_.blob->read_at(array_.begin + position_ * array_.stride, {window_.get(), bytes});
  cursor_ = 0;
}

template <class T>
void ElementStream::decode(size_t n, T* out) {
  const std::byte* in = window_.get() + cursor_;
  switch (array_.type) {
    case ComponentType::kByte:
      return convert_all<int8_t>(array_, in, n, out);
    case ComponentType::kUnsignedByte:
      return convert_all<uint8_t>(array_, in, n, out);
    case ComponentType::kShort:
      return convert_all<int16_t>(array_, in, n, out);
    case ComponentType::kUnsignedShort:
      return convert_all<uint16_t>(array_, in, n, out);
    case ComponentType::kUnsignedInt:
      return convert_all<uint32_t>(array_, in, n, out);
    case ComponentType::kFloat:
      // Never an index: readers of uint32 have rejected it before.
      if constexpr (std::is_same_v<T, double>) convert_all<float>(array_, in, n, out);
      return;
    case ComponentType::kDouble:
      if constexpr (std::is_same_v<T, double>) convert_all<double>(array_, in, n, out);
  }
}

void ElementStream::next_replacement() {
  uint32_t index = 0;
  const std::optional<uint64_t> before = replacement_;
  replacement_.reset();
  if (indices_->read(std::span<uint32_t>(&index, 1)) == 0) return;
  if ((before && index <= *before) || index >= array_.count) {
    fail_input(*path_, "has a sparse accessor whose indices do not increase inside it");
  }
  replacement_ = index;
}

template <class T>
void ElementStream::replace(uint64_t first, size_t n, T* out) {
  while (replacement_ && *replacement_ < first + n) {
    T* at = out + (*replacement_ - first) * array_.components;
    values_->read(std::span<T>(at, array_.components));
    next_replacement();
  }
}

template <class T>
size_t ElementStream::read(std::span<T> out) {
  const uint64_t first = position_;
  const size_t wanted =
      size_t(std::min<uint64_t>(out.size() / array_.components, array_.count - position_));
  T* to = out.data();
  for (size_t left = wanted; left > 0;) {
    size_t n = left;
    if (array_.blob == nullptr) {
      std::fill_n(to, n * array_.components, T(0));
    } else {
      if (in_window_ == 0) refill();
      n = size_t(std::min<uint64_t>(left, in_window_));
      decode(n, to);
      in_window_ -= n;
      cursor_ += n * array_.stride;
    }
    position_ += n;
    left -= n;
    to += n * array_.components;
  }
  replace(first, wanted, out.data());
  return wanted;
}

template size_t ElementStream::read(std::span<double>);
template size_t ElementStream::read(std::span<uint32_t>);

}  // namespace svdag
