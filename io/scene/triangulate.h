// Polygons into triangles, the same ones on every machine.
//
// A polygon of n corners gives n - 2 triangles whatever its shape: a fan from the first corner if
// it is convex, else ears clipped in a fixed order (Meisters 1975), in double arithmetic of fixed
// order on its projection along the dominant axis of its Newell normal (Sutherland, Sproull,
// Schumacker 1974). What no ear can be cut from (self-intersecting, zero area) ends as a fan.
//
// Weakly simple polygons are covered exactly, too: the ring may touch itself at corners and run
// along itself, as it does where a hole is joined by a slit. Not so where a corner touches the
// inside of an edge from within: no n - 2 triangles of the corners cover that, and what is left
// becomes a fan.
//
// Rejected: always a fan (covers area outside of a concave face), constrained Delaunay (prettier
// triangles of the same surface, and no voxel sees the difference).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "io/scene/mesh_reader.h"

namespace svdag {

class Triangulator {
 public:
  explicit Triangulator(MemoryBudget* budget) : reservation_(budget->reserve(0, kPurpose)) {}

  // The corners of the next polygon, in order.
  void corner(const Point& p) {
    if (corners_.size() == corners_.capacity()) grow();
    corners_.push_back(p);
  }
  // Hands the triangles to `writer` and starts the next polygon; fewer than 3 corners give none.
  void finish(BatchWriter& writer);

 private:
  static constexpr const char* kPurpose = "corners of a polygon";

  void grow();
  bool project();
  bool is_convex() const;
  double turn(size_t a, size_t b, size_t c) const;
  bool is_ear(uint32_t ear, uint64_t& work) const;
  bool leads_inside(size_t from, size_t right, size_t left, size_t to) const;
  bool forbids(uint32_t i, size_t a, size_t b, size_t c) const;
  void fan(BatchWriter& writer) const;
  void make_ring();
  uint32_t clip(uint32_t corner, BatchWriter& writer);
  uint32_t clip_slit(uint32_t corner, BatchWriter& writer);
  void clip_ears(BatchWriter& writer);

  MemoryBudget::Reservation reservation_;
  std::vector<Point> corners_;
  std::vector<glm::dvec2> flat_;       // the projection, counter-clockwise
  std::vector<uint32_t> prev_, next_;  // the ring of corners not clipped yet
  uint32_t left_ = 0;                  // how many there are
};

}  // namespace svdag
