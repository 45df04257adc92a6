// Reader of the colours of a HashDAG, NAME.basic_dag.uncompressed_colors.bin beside
// NAME.basic_dag.dag.bin: one for each voxel, in depth-first order.
//
// Layout: u32 number of top levels; u64 count and as many u64 (voxels below nodes of these levels,
// not needed here); u64 count and as many u32, the colours 0xAABBGGRR.
#pragma once

#include "io/colour.h"
#include "streaming/file/byte_stream.h"

namespace svdag {

class HashDagColours {
 public:
  // Any other file is an Error (kBadInput). It must outlive this.
  explicit HashDagColours(const File& file);

  uint64_t count() const { return count_; }
  // Of the next voxel.
  Colour next() {
    std::array<uint8_t, 4> rgba;
    stream_.read(std::as_writable_bytes(std::span(rgba)));
    return {rgba[0], rgba[1], rgba[2]};
  }

 private:
  ByteStream stream_;
  uint64_t count_ = 0;
};

}  // namespace svdag
