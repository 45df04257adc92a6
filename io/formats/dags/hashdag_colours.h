// Reader of the colours of a HashDAG, NAME.basic_dag.uncompressed_colors.bin beside
// NAME.basic_dag.dag.bin: one for each voxel, in depth-first order.
//
// Layout: u32 number of top levels; u64 count and as many u64 (voxels below nodes of these levels,
// not needed here); u64 count and as many u32, the colours 0xAABBGGRR.
#pragma once

#include <string>

#include "io/formats/label_numbers.h"
#include "streaming/file/byte_stream.h"

namespace svdag {

class HashDagColours {
 public:
  // Any other file is an Error (kBadInput). `layers`, which is empty, gets a layer for each colour.
  // Both must outlive this.
  HashDagColours(const File& file, LayerTable* layers);

  uint64_t count() const { return count_; }
  // The number of the layer of the next voxel. More than kMaxLayers are an Error (kBadInput).
  uint16_t next() {
    uint32_t colour = 0;
    stream_.read(std::as_writable_bytes(std::span(&colour, 1)));
    return numbers_.of(colour & 0xffffff);
  }

 private:
  ByteStream stream_;
  LabelNumbers numbers_;
  uint64_t count_ = 0;
};

}  // namespace svdag
