// The rank maps of one merged level: for each source, rank in the source -> index in the output.
//
// They are in memory, or spilled with one stream per source. Maps ascend, so they are written and
// read in order. Only looking up children is random access, with the map of one run at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "builder/workspace/scratch.h"
#include "streaming/memory/huge_vector.h"

namespace svdag {

// A rank map in memory, or a window of one, with its reservation.
struct RankMap {
  HugeVector<uint32_t> indices;
  MemoryBudget::Reservation reservation;
  uint64_t first = 0;  // rank of indices[0]

  bool holds(uint64_t rank) const { return rank - first < indices.size(); }
  uint32_t operator[](uint64_t rank) const { return indices[rank - first]; }
};

class RankMaps {
 public:
  RankMaps() = default;
  // counts[s]: number of keys of source s. The maps are spilled if `scratch` is given.
  RankMaps(std::span<const uint64_t> counts, Scratch* scratch, MemoryBudget* budget);
  RankMaps(RankMaps&&) = default;
  RankMaps& operator=(RankMaps&&) = default;
  // Spilled maps, with no source yet.
  static RankMaps without_sources(Scratch* scratch, MemoryBudget* budget) {
    return {{}, scratch, budget};
  }

  // Sets the index of a key of `source`. The ranks of a spilled map come in order, from one thread
  // at a time; the ranks of a map in memory come in any order, from several threads.
  void set(size_t source, uint64_t rank, uint32_t index) {
    if (writers_.empty()) {
      maps_[source].indices[rank] = index;
    } else {
      writers_[source].append(std::as_bytes(std::span(&index, 1)));
    }
  }
  // Must be called after the last set().
  void finish();
  // Appends the map of one more source: the map `member` of *into composed with the map `group` of
  // out_of. All maps are spilled; the map `member` is freed.
  void append_composed(RankMaps* into, size_t member, const RankMaps& out_of, size_t group);

  bool spilled() const { return scratch_ != nullptr; }
  size_t size() const { return spilled() ? streams_.size() : maps_.size(); }
  const RankMap& resident(size_t source) const { return maps_[source]; }
  // Loads the indices of ranks `begin` .. `end` - 1 of a spilled map, or fewer at its end.
  RankMap load(size_t source, uint64_t begin = 0, uint64_t end = UINT64_MAX) const;
  // Number of ranks of a spilled map.
  uint64_t count(size_t source) const { return streams_[source].bytes / sizeof(uint32_t); }
  uint64_t resident_bytes() const;
  // Frees a spilled map.
  void free(size_t source) const { scratch_->transient()->free(streams_[source]); }

 private:
  Scratch* scratch_ = nullptr;
  MemoryBudget* budget_ = nullptr;
  std::vector<RankMap> maps_;
  std::vector<SpillWriter> writers_;
  std::vector<SpillStream> streams_;
};

}  // namespace svdag
