// Polygons into triangles, the same ones on every machine.
//
// A polygon of n corners gives n - 2 triangles whatever its shape: a fan from the first corner if
// it is convex, else ears clipped in a fixed order (Meisters 1975), in double arithmetic of fixed
// order on its projection along the dominant axis of its Newell normal (Sutherland, Sproull,
// Schumacker 1974). A rest without ears (self-intersecting, zero area) becomes a fan.
// Corners that repeat the one before them are clipped first, as triangles without area.
//
// Large outlines take some hundred steps per corner. A corner is tested when its neighbours change,
// or when the corner that blocked it is gone (ear_candidates.h), and corners in its triangle are
// found by a tree (corner_tree.h), as FIST finds them by a grid (Held 2001). Both give the same
// result as testing each corner against all others, to the last bit.
//
// Weakly simple polygons are covered exactly, too: the ring may touch itself at corners and run
// along itself, as it does where a hole is joined by a slit. Not so where a corner touches the
// inside of an edge from within: no n - 2 triangles of the corners cover that, and what is left
// becomes a fan.
//
// Rejected: always a fan (covers area outside of a concave face), constrained Delaunay (prettier
// triangles of the same surface, and no voxel sees the difference), only reflex corners in the tree
// (Held; in an outline that touches itself another one may forbid an ear), monotone pieces (a
// sweep must order crossings, which rounding can contradict).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <string>
#include <utility>
#include <vector>

#include "io/scene/mesh/mesh_reader.h"
#include "io/scene/polygons/corner_tree.h"
#include "io/scene/polygons/ear_candidates.h"

namespace svdag {

class Triangulator {
 public:
  static constexpr uint64_t kStepsPerCorner = 1 << 14;

  // `path`: of the scene, for an Error. `steps`: max per corner of a polygon.
  Triangulator(MemoryBudget* budget, std::string path, uint64_t steps = kStepsPerCorner)
      : path_(std::move(path)),
        steps_(steps),
        reservation_(budget->reserve(0, kPurpose)),
        texture_reservation_(budget->reserve(0, kPurpose)) {}

  // The corners of the next polygon, in order.
  void corner(const Point& p) {
    if (corners_.size() == corners_.capacity()) grow();
    corners_.push_back(p);
  }
  // The same with the colour of the corner: of all corners of a polygon, or none.
  void corner(const Point& p, const VertexColour& colour) {
    corner(p);
    colours_.push_back(colour);
  }
  // The same, of a polygon whose corners are all in a texture.
  void corner(const Point& p, const TexturePoint& texture, const VertexColour& colour) {
    corner(p, colour);
    if (texture_.capacity() < corners_.capacity()) grow_texture();
    texture_.push_back(texture);
  }
  // Passes the triangles to `writer` and starts the next polygon; fewer than 3 corners give none.
  // One that takes too many steps is an Error (kBadInput); outlines take some hundreds per corner.
  void finish(BatchWriter& writer);
  // Steps of the search for ears in the last polygon; 0 if it was convex.
  uint64_t steps() const { return done_; }

 private:
  static constexpr const char* kPurpose = "corners of a polygon";

  void grow();
  void grow_texture();
  bool project();
  bool is_convex() const;
  double turn(size_t a, size_t b, size_t c) const;
  double most_left(size_t a, size_t b, const FlatBox& box) const;
  FlatBox reach(size_t a, size_t b, size_t c) const;
  bool is_ear(uint32_t ear);
  uint32_t next_ear(uint32_t from);
  bool leads_inside(size_t from, size_t right, size_t left, size_t to) const;
  bool forbids(uint32_t i, size_t a, size_t b, size_t c) const;
  void emit(size_t a, size_t b, size_t c, BatchWriter& writer) const;
  void fan(BatchWriter& writer) const;
  void make_ring();
  void count_step();
  void ask_again(uint32_t corner);
  uint32_t clip(uint32_t corner, BatchWriter& writer);
  void clip_repeats(BatchWriter& writer);
  uint32_t clip_slit(uint32_t corner, BatchWriter& writer);
  void clip_ears(BatchWriter& writer);

  const std::string path_;
  const uint64_t steps_;
  MemoryBudget::Reservation reservation_, texture_reservation_;
  std::vector<Point> corners_;
  std::vector<VertexColour> colours_;  // of the corners, or empty
  std::vector<TexturePoint> texture_;  // of the corners, or empty
  std::vector<glm::dvec2> flat_;       // the projection, counter-clockwise
  std::vector<uint32_t> prev_, next_;  // the ring of corners not clipped yet
  uint32_t left_ = 0;                  // their number
  CornerTree tree_;                    // the corners of the ring by place
  EarCandidates candidates_;
  uint64_t done_ = 0;  // steps
};

}  // namespace svdag
