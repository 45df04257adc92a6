// The corners and triangles of a glTF primitive; its points and indices may be shared or spilled.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "io/scene/gltf/gltf_elements.h"
#include "io/scene/gltf/gltf_transform.h"
#include "io/scene/mesh/corners.h"
#include "io/scene/mesh/mesh_reader.h"
#include "streaming/error.h"

namespace svdag {

enum Mode : uint64_t { kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6 };

// Reserved memory for points, kept from one primitive to the next: fresh pages cost more than the
// triangles of a small mesh.
class PointArray {
 public:
  std::span<Point> resize(uint64_t count, MemoryBudget* budget) {
    if (count > capacity_) {
      points_.reset();
      memory_.release();
      memory_ = budget->reserve(count * sizeof(Point), "glTF vertices");
      points_ = std::make_unique_for_overwrite<Point[]>(size_t(count));
      capacity_ = count;
    }
    return {points_.get(), size_t(count)};
  }
  void release() {
    points_.reset();
    memory_.release();
    capacity_ = 0;
  }
  uint64_t bytes() const { return memory_.bytes(); }

 private:
  MemoryBudget::Reservation memory_;
  std::unique_ptr<Point[]> points_;
  uint64_t capacity_ = 0;
};

// The corners of an unindexed primitive, transformed.
class SoupCorners {
 public:
  SoupCorners(const Accessor& positions, const Affine& to_world)
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
                                                   size_t count) {
  fail_input(path, "has the vertex index " + std::to_string(index) + " in a mesh of only " +
                       std::to_string(count) + " vertices");
}

// The corners of an indexed primitive; points[i] is in world space already.
template <class Points>
class IndexedCorners {
 public:
  IndexedCorners(const Accessor& indices, Points points)
      : stream_(indices), points_(points), path_(indices.path) {}

  decltype(auto) operator()() {
    if (next_ == filled_) {
      filled_ = stream_.read(std::span<uint32_t>(window_));
      next_ = 0;
    }
    const uint32_t index = window_[next_++];
    if (index >= points_.size()) fail_index(*path_, index, points_.size());
    return points_[index];
  }

 private:
  ElementStream stream_;
  Points points_;
  const std::string* path_;
  std::array<uint32_t, 4096> window_;
  size_t next_ = 0, filled_ = 0;
};

// Points as stored (Positions, or a run of corners.h), brought into world space one by one.
template <class Corners>
class PlacedPoints {
 public:
  PlacedPoints(Corners* points, const Affine& to_world) : points_(*points), to_world_(to_world) {}

  uint64_t size() const { return points_.size(); }
  Point operator[](uint64_t i) { return to_world_(points_[i]); }

 private:
  Corners& points_;
  Affine to_world_;
};

// The same of a primitive whose indices are in memory.
class KeptCorners {
 public:
  KeptCorners(std::span<const uint32_t> indices, std::span<const Point> points,
              const std::string& path)
      : next_(indices.data()), points_(points), path_(path) {}

  const Point& operator()() {
    const uint32_t index = *next_++;
    if (index >= points_.size()) fail_index(path_, index, points_.size());
    return points_[index];
  }

 private:
  const uint32_t* next_;
  std::span<const Point> points_;
  const std::string& path_;
};

// Makes triangles of `count` corners, in the order of section 3.7.2.1 of the specification.
template <class Corners>
void assemble(uint64_t mode, uint64_t count, Corners& corner, BatchWriter& out) {
  if (mode == kTriangles) {
    for (uint64_t i = 0; i + 2 < count; i += 3) {
      const Point a = corner(), b = corner();
      out.add(a, b, corner());
    }
    return;
  }
  if (count < 3) return;
  const Point first = corner();
  Point a = first, b = corner();
  for (uint64_t i = 0; i + 2 < count; ++i) {
    const Point c = corner();
    if (mode == kTriangleFan) {
      out.add(b, c, first);
    } else if (i % 2 == 0) {
      out.add(a, b, c);
    } else {
      out.add(a, c, b);
    }
    a = b;
    b = c;
  }
}

}  // namespace svdag
