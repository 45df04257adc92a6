// How a face loop gets the positions of its corners, wherever they are.
//
// A face loop is written once, for any `Corners`: corners[i] is the position of vertex i < size(),
// and add() takes the next vertex where vertices stand between faces. Positions in memory are such
// corners themselves. Others need two runs of the loop over the same bytes (vertex_windows.h), so
// which corners it asks for, and in which order, must not depend on positions.
#pragma once

#include <type_traits>

#include "io/scene/mesh_reader.h"
#include "io/scene/positions.h"
#include "streaming/error.h"
#include "streaming/interrupt.h"

namespace svdag {

// The first run: notes what is asked for.
class CornerRecorder {
 public:
  explicit CornerRecorder(Positions* positions) : positions_(*positions) {}

  uint64_t size() const { return positions_.size(); }
  void add(const Point& p) { positions_.add(p); }
  Point operator[](uint64_t i) {
    positions_.windows().record(i);
    return Point(0);
  }
  static constexpr bool spilled() { return false; }

 private:
  Positions& positions_;
};

// The second run: gives what was asked for.
class CornerReplayer {
 public:
  // From the first corner that was recorded, when there were `size` of all `positions`. One at a
  // time.
  CornerReplayer(Positions* positions, uint64_t size)
      : windows_(positions->windows()), size_(size), all_(positions->size()) {
    windows_.rewind();
  }

  uint64_t size() const { return size_; }
  void add(const Point&) { size_ += size_ < all_; }
  Point operator[](uint64_t i) { return windows_.next(i); }
  static constexpr bool spilled() { return false; }

 private:
  VertexWindows& windows_;
  uint64_t size_, all_;
};

// The triangle of three vertices. In memory they are read in whatever order is the quickest, else
// in that of the arguments: both runs must ask alike.
template <class Corners>
void add_triangle(Corners& corners, uint64_t a, uint64_t b, uint64_t c, BatchWriter& writer) {
  if constexpr (std::is_same_v<Corners, Positions>) {
    writer.add(corners[a], corners[b], corners[c]);
  } else {
    const Point pa = corners[a], pb = corners[b], pc = corners[c];
    writer.add(pa, pb, pc);
  }
}

// The first run of spilled positions: calls faces(corners, writer) for a writer that nobody reads.
// A broken file is no Error yet: the second run meets it again, behind the triangles before it.
template <class Faces>
void record_corners(Positions* positions, const Faces& faces) {
  const TriangleSink nowhere = [](const TriangleBatch&) { check_interrupt(); };
  BatchWriter unseen(nowhere);
  CornerRecorder recorder(positions);
  try {
    faces(recorder, unseen);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
  }
  positions->join();
}

// Calls faces(corners, writer), once, or where the positions were spilled or become so on the way
// twice more from where it stopped. In the end `writer` has the same triangles, and the caller the
// same Error.
template <class Faces>
void read_corners(Positions* positions, BatchWriter& writer, const Faces& faces) {
  if (!positions->spilled()) faces(*positions, writer);
  if (!positions->spilled()) return;
  const uint64_t size = positions->size();
  record_corners(positions, faces);
  CornerReplayer replayer(positions, size);
  faces(replayer, writer);
}

}  // namespace svdag
