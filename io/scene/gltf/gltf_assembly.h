// The triangles of a glTF primitive, from the corners that it lists: points, or numbers of
// vertices.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "io/affine.h"
#include "io/scene/gltf/document/gltf_elements.h"
#include "streaming/error.h"

namespace svdag {

enum Mode : uint64_t { kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6 };

// The corners of an unindexed primitive, in the world.
class PointStream {
 public:
  PointStream(const Accessor& positions, const Affine& to_world)
      : stream_(positions), to_world_(to_world) {}

  Point operator()() {
    if (next_ == filled_) {
      filled_ = stream_.read(as_numbers(window_));
      next_ = 0;
    }
    return to_world_(window_[next_++]);
  }

 private:
  ElementStream stream_;
  Affine to_world_;
  std::array<Point, 1024> window_;
  size_t next_ = 0, filled_ = 0;
};

// Out of line, so that the loops below stay small enough to be inlined.
[[noreturn, gnu::noinline]] inline void fail_index(const std::string& path, uint32_t index,
                                                   uint64_t count) {
  fail_input(path, "has the vertex index " + std::to_string(index) + " in a mesh of only " +
                       std::to_string(count) + " vertices");
}

// The corners of an indexed primitive of `vertices` vertices, from the file or from memory.
class IndexStream {
 public:
  IndexStream(const Accessor& indices, uint64_t vertices)
      : stream_(indices), vertices_(vertices), path_(*indices.path) {}
  IndexStream(std::span<const uint32_t> indices, uint64_t vertices, const std::string& path)
      : next_(indices.data()), end_(next_ + indices.size()), vertices_(vertices), path_(path) {}
  IndexStream(const IndexStream&) = delete;  // points into its own window
  IndexStream& operator=(const IndexStream&) = delete;

  uint32_t operator()() {
    if (next_ == end_) refill();
    const uint32_t index = *next_++;
    if (index >= vertices_) fail_index(path_, index, vertices_);
    return index;
  }

 private:
  void refill() {
    next_ = window_.data();
    end_ = next_ + stream_->read(std::span<uint32_t>(window_));
  }

  std::optional<ElementStream> stream_;
  const uint32_t *next_ = nullptr, *end_ = nullptr;
  uint64_t vertices_;
  const std::string& path_;
  std::array<uint32_t, 4096> window_;
};

// Calls add() for the triangles of `count` corners, in the order of section 3.7.2.1 of the
// specification.
template <class Corners, class Add>
void assemble(uint64_t mode, uint64_t count, Corners& corner, const Add& add) {
  if (mode == kTriangles) {
    for (uint64_t i = 0; i + 2 < count; i += 3) {
      const auto a = corner(), b = corner();
      add(a, b, corner());
    }
    return;
  }
  if (count < 3) return;
  const auto first = corner();
  auto a = first, b = corner();
  for (uint64_t i = 0; i + 2 < count; ++i) {
    const auto c = corner();
    if (mode == kTriangleFan) {
      add(b, c, first);
    } else if (i % 2 == 0) {
      add(a, b, c);
    } else {
      add(a, c, b);
    }
    a = b;
    b = c;
  }
}

}  // namespace svdag
