// Access of a face loop to the positions of its corners, in memory or spilled.
//
// A face loop is written once, for any `Corners`: corners[i] is the position of vertex i < size(),
// and add() appends the next vertex where vertices are interleaved with faces. Positions in memory
// are Corners themselves. Spilled ones need two runs of the loop over the same bytes
// (vertex_windows.h), so the corners it requests, their order, and the triangles it makes must not
// depend on positions.
#pragma once

#include <type_traits>

#include "io/scene/mesh/mesh_reader.h"
#include "io/scene/mesh/positions.h"
#include "io/scene/mesh/vertex_marks.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {

// A run over spilled positions: counts the vertices so far.
class SpilledCorners {
 public:
  // Starts when there are `size` vertices.
  SpilledCorners(Positions* positions, uint64_t size) : positions_(*positions), size_(size) {}

  uint64_t size() const { return size_; }
  // The first run adds new vertices; the second one passes them again.
  void add(const Point& p) {
    if (size_ == positions_.size()) positions_.add(p);
    ++size_;
  }
  static constexpr bool spilled() { return false; }

 protected:
  Positions& positions_;

 private:
  uint64_t size_;
};

// The first run: records the requested corners.
class CornerRecorder : public SpilledCorners {
 public:
  using SpilledCorners::SpilledCorners;
  Point operator[](uint64_t i) {
    positions_.windows().record(i);
    return Point(0);
  }
};

// The second run: returns the recorded corners from the beginning. Only one may exist.
class CornerReplayer : public SpilledCorners {
 public:
  CornerReplayer(Positions* positions, uint64_t size) : SpilledCorners(positions, size) {
    positions->windows().rewind();
  }
  void add(const Point&) {
    if (size() == positions_.size()) fail_changed();
    SpilledCorners::add({});
  }
  Point operator[](uint64_t i) { return positions_.windows().next(i); }
};

// For the box only: corners that carry their index.
class CornerNumbers : public SpilledCorners {
 public:
  using SpilledCorners::SpilledCorners;
  Point operator[](uint64_t i) { return {double(i), 0, 0}; }
};

// The triangle of three vertices. In memory they are read in any order; spilled ones in the order
// of the arguments, because both runs must request the same sequence.
template <class Corners>
void add_triangle(Corners& corners, uint64_t a, uint64_t b, uint64_t c, BatchWriter& writer) {
  if constexpr (std::is_same_v<Corners, Positions>) {
    writer.add(corners[a], corners[b], corners[c]);
  } else {
    const Point pa = corners[a], pb = corners[b], pc = corners[c];
    writer.add(pa, pb, pc);
  }
}

// A run that discards its triangles. Returns false for a damaged file instead of throwing: the last
// run reports the damage, after the triangles before it.
template <class Corners, class Faces>
bool finish_faces(Corners& corners, BatchWriter& writer, const Faces& faces) {
  try {
    faces(corners, writer);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    return false;
  }
  return true;
}

// Tries to find the box without the triangles; true if it was added to `into`.
template <class Faces>
bool read_box_alone(Positions* positions, uint64_t size, const Faces& faces, MeshBox* into) {
  const ReadOptions& options = positions->options();
  const uint64_t room = options.spill->share - options.spill->share / 8;  // the rest is for blocks
  if (size / 8 > room) return false;
  VertexMarks marks(options.budget, room);
  uint64_t triangles = 0;
  const TriangleSink mark = [&](const TriangleBatch& batch) {
    check_interrupt();
    triangles += batch.triangles.size();
    for (const Triangle& t : batch.triangles) {
      for (const Point& corner : t.v) marks.mark(uint64_t(corner.x));
    }
  };
  BatchWriter writer(mark);
  CornerNumbers numbers(positions, size);
  if (!finish_faces(numbers, writer, faces)) return false;
  writer.flush();
  positions->hand_over();
  const auto box = marks.box(&positions->windows());
  if (!box) return false;
  into->box.add(*box);
  into->triangles += triangles;
  return true;
}

// The first run over spilled positions, beginning when there are `size`, and the join.
template <class Faces>
void record_corners(Positions* positions, uint64_t size, const Faces& faces) {
  const TriangleSink nowhere = [](const TriangleBatch&) { check_interrupt(); };
  BatchWriter unseen(nowhere);
  CornerRecorder recorder(positions, size);
  finish_faces(recorder, unseen, faces);
  positions->hand_over();
  positions->windows().join();
}

// Calls faces(corners, writer) once; if the positions are or become spilled, repeatedly from the
// place where it stopped. `writer` gets the same triangles in both cases, and the caller the same
// Error.
template <class Faces>
void read_corners(Positions* positions, BatchWriter& writer, const Faces& faces) {
  if (!positions->spilled()) faces(*positions, writer);
  if (!positions->spilled()) return;
  const uint64_t size = positions->size();
  MeshBox* alone = positions->options().box_alone;
  if (alone != nullptr && read_box_alone(positions, size, faces, alone)) return;
  record_corners(positions, size, faces);
  CornerReplayer replayer(positions, size);
  faces(replayer, writer);
}

}  // namespace svdag
