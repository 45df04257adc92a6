// The structures of a packed file, `.svdag.pack` (docs/pack-format.md).
//
//   header | layer table | chunks, deepest level first | chunks of colours | index
//
// A chunk holds up to kChunkNodes successive nodes (or bricks) of one level of the plain layout, as
// streams of bytes (io/dag/pack/node_streams.h), each a zstd frame of its own. Chunks are
// independent. The parts of the colours are packed as if their bytes were bricks.
#pragma once

#include "io/dag/format.h"

namespace svdag {

constexpr unsigned char kPackedMagic[8] = {0x89, 'S', 'V', 'P', 'K', '\r', '\n', 0x1a};
constexpr uint32_t kMaxPackedVersion = 2;
constexpr uint32_t packed_version(const Header& plain) {
  return has_colours(plain) ? 2 : 1;
}
constexpr uint32_t kChunkNodes = 1 << 14;

// The number of u64 that hold a part of the colours; zeros fill the last one.
constexpr uint64_t bricks_of_bytes(uint64_t bytes) {
  return bytes / 8 + (bytes % 8 != 0);
}

struct PackedHeader {
  unsigned char magic[8];
  uint32_t version;
  uint32_t padding;         // zero
  uint64_t chunks;          // entries of the index
  uint64_t index_offset;    // the index ends with the file
  uint64_t index_checksum;  // XXH3-64 of the index
  Header plain;             // of the file in the plain layout
  uint64_t checksum;        // XXH3-64 of the bytes before
};

struct ChunkEntry {
  uint64_t offset;    // of the chunk in the file
  uint64_t checksum;  // XXH3-64 of its bytes
  uint32_t bytes;
  uint32_t nodes;
};

static_assert(sizeof(PackedHeader) == 48 + sizeof(Header));
static_assert(sizeof(ChunkEntry) == 24);

}  // namespace svdag
