// Consecutive keys of a level on their way into a file, in three steps: any thread encodes them,
// one after the other they are appended, which gives them their places, and any thread stores
// (checks and writes) the blocks that this has filled.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/brick.h"
#include "io/dag/write/node_key.h"
#include "streaming/error.h"
#include "streaming/file/block_filler.h"

namespace svdag {

// A key as it is compared.
inline NodeKey key_of(Brick brick) {
  return {uint32_t(brick >> 32), uint32_t(brick)};
}
inline const NodeKey& key_of(const NodeKey& node) {
  return node;
}

struct LevelPiece {
  std::vector<std::byte> bytes;   // the keys as in the file
  std::vector<uint32_t> indices;  // of each key; 0 for the first
  NodeKey first{}, last{};        // keys; a brick has its high word first
  FilledBlocks filled;

  void clear() {
    bytes.clear();
    indices.clear();
  }
  // Adds a key without its bytes. Keys ascend.
  void add(const NodeKey& key, size_t index) {
    SVDAG_ASSERT(indices.empty() || last < key);
    if (indices.empty()) first = key;
    last = key;
    indices.push_back(uint32_t(index));
  }
  // Adds keys that are in the file as they are, with their ranks as indices.
  template <class Key>
  void add_as_they_are(std::span<const Key> keys) {
    for (const Key& key : keys) add(key_of(key), indices.size());
    const auto added = std::as_bytes(keys);
    bytes.insert(bytes.end(), added.begin(), added.end());
  }
};

}  // namespace svdag
