// Vertex positions that do not fit in memory: an external join brings them to the corners that
// refer to them, in sequential passes for any order of the faces.
//
// A window is a run of consecutive vertices that fits in memory.
//   add      the positions go to one stream per window as they are read
//   record   corners are requested without receiving them: the index of each within its window is
//            appended to the references of the window
//   join     per window: its positions in memory, its references one by one, the position of each
//            appended to the answers of the window
//   next     each corner, in the order of the recording, takes the next answer of its window
// The caller keeps the window of each corner, so nothing is sorted and no index of a corner is
// stored. Rejected: mapping the positions (random reads of a disk), sorting by vertex and
// back by corner (the same bytes three times).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "io/scene/mesh/mesh_reader.h"
#include "io/triangle.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/spill/spill_file.h"

namespace svdag {

// A stream whose blocks are freed with it.
class OwnedStream {
 public:
  OwnedStream() = default;
  OwnedStream(SpillFile* file, SpillStream stream) : file_(file), stream_(std::move(stream)) {}
  OwnedStream(OwnedStream&& other) noexcept
      : file_(std::exchange(other.file_, nullptr)), stream_(std::move(other.stream_)) {}
  OwnedStream& operator=(OwnedStream&& other) noexcept;
  ~OwnedStream();

  bool empty() const { return file_ == nullptr; }
  const SpillStream& stream() const { return stream_; }
  SpillReader read(MemoryBudget* budget) const { return SpillReader(file_, stream_, budget); }

 private:
  SpillFile* file_ = nullptr;
  SpillStream stream_;
};

// The file of the space; Error (kMemory) if the share is too small for it.
SpillFile* open_spill(const SpillSpace& space);

template <class T>
Point load_point(const std::byte* p) {
  std::array<T, 3> v;
  std::memcpy(&v, p, sizeof v);
  return {double(v[0]), double(v[1]), double(v[2])};
}

// Reports that a run over the same bytes found other corners or vertices than the previous one.
[[noreturn]] void fail_changed();

class VertexWindows {
 public:
  // Positions are three floats each, or (`single` is false) three doubles.
  VertexWindows(const SpillSpace& space, MemoryBudget* budget, bool single);

  // Number of vertices of a window: a power of two.
  uint64_t window() const { return uint64_t(1) << shift_; }
  uint64_t size() const { return size_; }
  uint64_t max_vertices() const { return max_windows_ << shift_; }

  // Appends whole positions.
  void add(std::span<const std::byte> positions);
  // Returns the window.
  uint64_t record(uint64_t i) {
    const uint64_t w = i >> shift_;
    if (w >= references_.size() || !references_[w]) open_references(w);
    const uint32_t local = uint32_t(i & (window() - 1));
    references_[w]->append(std::as_bytes(std::span(&local, 1)));
    return w;
  }
  // Every position was added and every corner recorded.
  void join();
  // Restarts at the first recorded corner.
  void rewind();
  // The position of the next corner that was recorded in window `w`.
  Point next(uint64_t w) {
    if (w >= replay_.size()) fail_changed();
    return next_of(replay_[w], answers_[w]);
  }

 private:
  // A cursor in a stream of positions.
  struct Cursor {
    const std::byte *here = nullptr, *end = nullptr;  // in the block of the reader
    std::optional<SpillReader> reader;
  };

  Point next_of(Cursor& from, const OwnedStream& stream) {
    if (size_t(from.end - from.here) < position_bytes_) return next_beyond(from, stream);
    const std::byte* p = from.here;
    from.here += position_bytes_;
    return point_at(p);
  }
  Point point_at(const std::byte* p) const {
    return single_ ? load_point<float>(p) : load_point<double>(p);
  }
  SpillWriter new_stream() { return SpillWriter(file_, new_number_(), budget_); }
  void finish_window();
  void open_references(uint64_t w);
  void load(const OwnedStream& positions, std::byte* to) const;
  template <class T>
  OwnedStream answer(const OwnedStream& references, const std::byte* positions);
  Point next_beyond(Cursor& from, const OwnedStream& stream);

  SpillFile* file_;
  const std::function<uint64_t()>& new_number_;
  MemoryBudget* budget_;
  bool single_;
  size_t position_bytes_;
  int shift_;
  uint64_t max_windows_;  // max windows whose references can be written at once
  uint64_t size_ = 0;
  std::optional<SpillWriter> positions_out_;  // of the last window
  std::vector<OwnedStream> positions_, answers_;
  std::vector<std::optional<SpillWriter>> references_;
  std::vector<Cursor> replay_;
};

}  // namespace svdag
