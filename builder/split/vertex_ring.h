// The newest vertices of a stream of triangles, which later corners refer to by their distance.
//
// Neighbouring triangles of a mesh share vertices, and in file order they are near each other: in a
// scan five of six corners are among the vertices of the last two rows. A ring forgets the oldest
// vertex for each that it takes, so a bin needs a fixed amount of memory, whatever the size of its
// stream. Which corners are found affects only the size of the stream.
// Rejected: the codecs of meshoptimizer (they code the indexed triangles of a whole block at once,
// which hundreds of open bins would have to hold, and let corners change places).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>

#include "io/triangle.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class VertexRing {
 public:
  static constexpr int kMinLog2 = 6, kMaxLog2 = 14;

  VertexRing(int size_log2, MemoryBudget* budget)
      : memory_(budget->reserve(sizeof(LatticePoint) << size_log2, "vertices of bins")),
        mask_((uint64_t(1) << size_log2) - 1),
        vertices_(std::make_unique_for_overwrite<LatticePoint[]>(size_t(mask_ + 1))) {}

  void add(const LatticePoint& p) { vertices_[count_++ & mask_] = p; }
  // Vertices so far, also those that were forgotten.
  uint64_t count() const { return count_; }
  bool holds(uint64_t distance) const {
    return distance >= 1 && distance <= std::min(count_, mask_ + 1);
  }
  // A vertex that the ring holds; distance 1: the newest.
  const LatticePoint& operator[](uint64_t distance) const {
    return vertices_[(count_ - distance) & mask_];
  }

 private:
  MemoryBudget::Reservation memory_;
  uint64_t mask_;
  uint64_t count_ = 0;
  std::unique_ptr<LatticePoint[]> vertices_;
};

// A ring in which vertices are found: a hash table of buckets for two, the newer one first.
class VertexFinder {
 public:
  // Half a thousand of them take a sixteenth of the budget.
  static int size_log2(const MemoryBudget& budget) {
    const int log2 = int(std::bit_width(budget.limit() >> 18)) - 1;
    return std::clamp(log2, VertexRing::kMinLog2, VertexRing::kMaxLog2);
  }

  VertexFinder(int size_log2, MemoryBudget* budget)
      : ring_(size_log2, budget),
        memory_(budget->reserve(sizeof(Bucket) << size_log2, "vertices of bins")),
        shift_(64 - size_log2),
        buckets_(std::make_unique<Bucket[]>(size_t(1) << size_log2)) {}

  const VertexRing& ring() const { return ring_; }
  // The distance of `p`; 0 if it is not found, and added.
  uint64_t find_or_add(const LatticePoint& p) {
    uint64_t hash = uint64_t(p.x) * 0x9e3779b97f4a7c15;
    hash = (std::rotl(hash, 27) ^ uint64_t(p.y)) * 0x9e3779b97f4a7c15;
    hash = (std::rotl(hash, 27) ^ uint64_t(p.z)) * 0x9e3779b97f4a7c15;
    Bucket& bucket = buckets_[hash >> shift_];
    for (const uint32_t number : bucket.newest) {
      const uint32_t distance = uint32_t(ring_.count()) - number;
      if (ring_.holds(distance) && ring_[distance] == p) return distance;
    }
    bucket = {{uint32_t(ring_.count()), bucket.newest[0]}};
    ring_.add(p);
    return 0;
  }

 private:
  struct Bucket {
    uint32_t newest[2] = {};  // numbers of vertices, modulo 2^32: stale ones are not equal
  };

  VertexRing ring_;
  MemoryBudget::Reservation memory_;
  int shift_;
  std::unique_ptr<Bucket[]> buckets_;
};

}  // namespace svdag
