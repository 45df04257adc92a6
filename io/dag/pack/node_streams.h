// The streams of a chunk: its nodes or bricks, transposed and predicted so that zstd finds little
// else to remove.
//
// Nodes ascend in content order, so a node is much like the one before it. Notation: children are
// 1 + their rank in the level below; last[c] is the last child of number c that is present in the
// chunk, 0 at first. In the order of c, a child that is present is one of
//
//   equal       to last[c]                                        bit c of a byte per node
//   ascending   the first that differs from the node before, where that has one, too: greater than
//               last[c]                                           child - last[c] - 1, a u32
//   followed    the child that last came after the same child, by a table of hashes
//                                                                 bit c of a byte per node
//   other                                                         child, a u32
//
// Streams: masks, bits "equal", bits "followed" (a byte per node each), and the four planes of
// bytes of each u32. Bricks: the eight planes of their bytes.
//
// Rejected, in percent of the plain file for sponza at 16K^3 (this: 30.0): only zstd on the plain
// file 38.9, on the compact one 36.3; chunks four times as large 30.1.
// Rejected as well: nodes ordered by place, so that a window could be read (unpacking would need
// a sort, or 20 bits a node for the order); the kind of a child chosen by a table instead of
// branches (a third slower).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/brick.h"
#include "io/dag/write/node_key.h"

namespace svdag {

constexpr size_t kNodeStreams = 11;
constexpr size_t kBrickStreams = 8;
using Stream = std::vector<unsigned char>;

std::array<Stream, kNodeStreams> streams_of_nodes(std::span<const NodeKey> nodes);
std::array<Stream, kBrickStreams> streams_of_bricks(std::span<const Brick> bricks);

// The largest size of stream i, in bytes, of a chunk of `nodes` nodes.
constexpr size_t max_stream_bytes(size_t i, size_t nodes) {
  return i < 3 ? nodes : 8 * nodes;
}

// No less than the bytes of a chunk of `nodes` nodes or bricks: its streams, and a KiB for what
// zstd and the chunk add to each.
constexpr uint64_t max_chunk_bytes(uint64_t nodes) {
  uint64_t bytes = kNodeStreams * 1024;
  for (size_t i = 0; i < kNodeStreams; ++i) bytes += max_stream_bytes(i, nodes);
  return bytes;
}

// The nodes of a chunk.
struct ChunkNodes {
  std::vector<unsigned char> masks;
  std::vector<uint32_t> children;  // of all nodes, one after the other, and 8 zeros
  bool ascend;                     // in content order; then none is empty
};

// Writes the nodes of the streams, whose children are at most `below`, to *nodes; false if the
// streams do not fit together.
bool nodes_of_streams(const std::array<Stream, kNodeStreams>& streams, size_t count, uint64_t below,
                      ChunkNodes* nodes);
bool bricks_of_streams(std::span<const Stream, kBrickStreams> streams, size_t count,
                       std::vector<Brick>* bricks);

}  // namespace svdag
