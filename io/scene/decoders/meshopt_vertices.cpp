#include "io/scene/decoders/meshopt_vertices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace svdag {
namespace {

constexpr std::byte kVersion1{0xa1};
constexpr size_t kMaxBlock = 256, kBlockBytes = 8192, kGroup = 16;
constexpr size_t kMinTail = 24;

using Stream = std::array<uint8_t, kMaxBlock>;

// The bytes in order; reading past the end fails for good.
class Bytes {
 public:
  explicit Bytes(std::span<const std::byte> data) : data_(data) {}

  std::span<const std::byte> take(size_t count) {
    if (count > data_.size()) {
      failed_ = true;
      data_ = {};
      return {};
    }
    const auto taken = data_.first(count);
    data_ = data_.subspan(count);
    return taken;
  }
  uint8_t byte() {
    const auto one = take(1);
    return one.empty() ? uint8_t(0) : uint8_t(one[0]);
  }
  bool failed() const { return failed_; }
  size_t left() const { return data_.size(); }

 private:
  std::span<const std::byte> data_;
  bool failed_ = false;
};

// 16 codes of `bits` bits: the first in the highest bits of a byte, single bits in the lowest.
void read_group(Bytes* data, unsigned bits, uint8_t* out) {
  if (bits == 0) return void(std::fill_n(out, kGroup, uint8_t(0)));
  const auto codes = data->take(2 * bits);
  if (codes.empty()) return;
  const unsigned per_byte = 8 / bits, largest = (1u << bits) - 1;
  for (unsigned i = 0; i < kGroup; ++i) {
    const unsigned at = i % per_byte;
    const unsigned shift = bits == 1 ? at : 8 - bits * (at + 1);
    const unsigned code = unsigned(codes[i / per_byte]) >> shift & largest;
    out[i] = code == largest && bits < 8 ? data->byte() : uint8_t(code);
  }
}

void read_stream(Bytes* data, unsigned control, size_t count, Stream* stream) {
  constexpr std::array<unsigned, 5> kBits = {0, 1, 2, 4, 8};
  if (control == 2) return stream->fill(0);
  if (control == 3) {
    const auto stored = data->take(count);
    if (!stored.empty()) std::memcpy(stream->data(), stored.data(), count);
    return;
  }
  const size_t groups = (count + kGroup - 1) / kGroup;
  const auto sizes = data->take((groups + 3) / 4);
  for (size_t g = 0; g < groups && !data->failed(); ++g) {
    const unsigned size = unsigned(sizes[g / 4]) >> (2 * (g % 4)) & 3;
    read_group(data, kBits[size + control], stream->data() + g * kGroup);
  }
}

template <class T>
T unzigzag(T v) {
  return T(T(0 - (v & 1)) ^ (v >> 1));
}

// Four bytes of all vertices, from their streams. `before`: of the vertex before the first.
void undo_differences(const std::array<Stream, 4>& streams, unsigned channel, size_t count,
                      uint64_t stride, const std::byte* before, std::byte* out) {
  std::array<std::byte, 4> previous;
  std::memcpy(previous.data(), before, 4);
  for (size_t i = 0; i < count; ++i, out += stride) {
    std::array<uint8_t, 4> coded;
    for (size_t k = 0; k < 4; ++k) coded[k] = streams[k][i];
    if ((channel & 3) == 0) {
      for (size_t k = 0; k < 4; ++k)
        previous[k] = std::byte(uint8_t(unzigzag(coded[k]) + uint8_t(previous[k])));
    } else if ((channel & 3) == 1) {
      auto values = std::bit_cast<std::array<uint16_t, 2>>(previous);
      const auto steps = std::bit_cast<std::array<uint16_t, 2>>(coded);
      for (size_t k = 0; k < 2; ++k) values[k] = uint16_t(values[k] + unzigzag(steps[k]));
      previous = std::bit_cast<std::array<std::byte, 4>>(values);
    } else {
      const uint32_t turned = std::rotr(std::bit_cast<uint32_t>(coded), int(channel >> 4));
      previous =
          std::bit_cast<std::array<std::byte, 4>>(std::bit_cast<uint32_t>(previous) ^ turned);
    }
    std::memcpy(out, previous.data(), 4);
  }
}

}  // namespace

bool is_meshopt_version_1(std::span<const std::byte> data) {
  return !data.empty() && data[0] == kVersion1;
}

bool decode_meshopt_vertices(std::span<const std::byte> data, uint64_t stride,
                             std::span<std::byte> out) {
  const size_t words = size_t(stride / 4), tail_bytes = size_t(stride) + words;
  if (data.size() < 1 + std::max(tail_bytes, kMinTail)) return false;
  const auto tail = data.last(tail_bytes);
  const auto channels = tail.subspan(size_t(stride));
  const std::byte* before = tail.data();
  Bytes bytes(data.subspan(1));
  const size_t max_block = std::min(kBlockBytes / size_t(stride) / kGroup * kGroup, kMaxBlock);
  std::array<Stream, 4> streams;
  while (!out.empty()) {
    const size_t count = std::min(max_block, out.size() / size_t(stride));
    const auto controls = bytes.take(words);
    for (size_t w = 0; w < words && !bytes.failed(); ++w) {
      for (size_t k = 0; k < 4; ++k)
        read_stream(&bytes, unsigned(controls[w]) >> (2 * k) & 3, count, &streams[k]);
      if ((unsigned(channels[w]) & 3) == 3) return false;
      undo_differences(streams, unsigned(channels[w]), count, stride, before + 4 * w,
                       out.data() + 4 * w);
    }
    if (bytes.failed()) return false;
    before = out.data() + (count - 1) * size_t(stride);
    out = out.subspan(count * size_t(stride));
  }
  return bytes.left() == std::max(tail_bytes, kMinTail);
}

}  // namespace svdag
