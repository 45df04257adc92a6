// The numbers of the vertices of a tile, each once: a hash table with open addressing, which is
// emptied by counting its generation up.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "io/formats/surfaces/surface.h"

namespace svdag {

class TileVertices {
 public:
  void clear() {
    used_ = 0;
    if (++generation_ == 0) slots_.assign(slots_.size(), Slot()), generation_ = 1;
  }

  // Appends the vertex to *all if it is new.
  uint32_t number_of(const SurfaceTile::Vertex& vertex, std::vector<SurfaceTile::Vertex>* all) {
    if (2 * used_ >= slots_.size()) grow(*all);
    Slot& slot = find(vertex, *all);
    if (slot.generation == generation_) return slot.number;
    slot = {generation_, uint32_t(all->size())};
    all->push_back(vertex);
    ++used_;
    return slot.number;
  }

 private:
  struct Slot {
    uint32_t generation = 0, number = 0;
  };

  static uint64_t hash_of(const SurfaceTile::Vertex& v) {
    const uint64_t place = uint64_t(uint32_t(v.at[0])) << 42 ^ uint64_t(uint32_t(v.at[1])) << 21 ^
                           uint64_t(uint32_t(v.at[2]));
    const uint64_t colour = uint64_t(v.colour.r) << 16 | v.colour.g << 8 | v.colour.b;
    return (place ^ colour * 0x9e3779b97f4a7c15U) * 0xd6e8feb86659fd93U;
  }
  Slot& find(const SurfaceTile::Vertex& vertex, const std::vector<SurfaceTile::Vertex>& all) {
    const size_t mask = slots_.size() - 1;
    size_t i = size_t(hash_of(vertex) >> 32) & mask;
    for (;; i = (i + 1) & mask) {
      if (slots_[i].generation != generation_) return slots_[i];
      const SurfaceTile::Vertex& other = all[slots_[i].number];
      if (other.at == vertex.at && other.colour == vertex.colour) return slots_[i];
    }
  }
  void grow(const std::vector<SurfaceTile::Vertex>& all) {
    slots_.assign(std::max<size_t>(1024, 2 * slots_.size()), Slot());
    for (uint32_t i = 0; i < all.size(); ++i) find(all[i], all) = {generation_, i};
  }

  std::vector<Slot> slots_;  // a power of two
  uint32_t generation_ = 1;
  size_t used_ = 0;
};

}  // namespace svdag
