// The layout of a pack (builder/cache/cell_pack.h).
//
//   header | bricks | nodes of height 3, 4, ... | entries | checksums
//
// Nodes are stored by height instead of level (a node of height h covers 2^h voxels a side, bricks
// have height 2), so that a pack serves grids of any resolution. Each height is sorted and closed
// like a level of a run (builder/reduce/run.h): children are 1 + rank in the height below. An entry
// maps a key to the node that is its sub-DAG, or to no node if the cell is empty. There is one
// checksum per block of 64 KiB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "builder/cache/cell_store.h"
#include "builder/cache/pack_payload.h"
#include "io/brick.h"
#include "io/dag/node_key.h"

namespace svdag {

constexpr uint32_t kBrickHeight = 2;
constexpr uint32_t kNoNode = 0xffffffffU;

struct PackEntry {
  CellKey key;
  uint64_t voxels;
  uint32_t height;
  uint32_t rank;  // kNoNode: the cell is empty
};

struct PackHeader {
  static constexpr uint32_t kHeights = 21;

  char magic[8];
  uint32_t version;
  uint32_t unused;
  uint64_t keys[kHeights];  // [h]: number of keys of height h
  uint64_t entries;
  uint64_t file_bytes;
  unsigned char reserved[48];  // zero
  uint64_t checksum;           // XXH3-64 of the fields before
};
static_assert(sizeof(PackHeader) == kPackBegin && sizeof(PackEntry) == 48);

constexpr uint64_t pack_key_bytes(uint32_t height) {
  return height == kBrickHeight ? sizeof(Brick) : sizeof(NodeKey);
}

// Start of the section of `height`, relative to kPackBegin; that of kHeights holds the entries.
inline uint64_t pack_section(const PackHeader& header, uint32_t height) {
  uint64_t at = 0;
  for (uint32_t h = kBrickHeight; h < height; ++h)
    at = align_pack(at + header.keys[h] * pack_key_bytes(h));
  return at;
}

// The keys in the bytes of a section, or in a chunk of it.
template <class Key>
std::span<const Key> keys_in(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const Key*>(bytes.data()), bytes.size() / sizeof(Key)};
}

}  // namespace svdag
