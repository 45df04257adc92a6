// The file format `.run`, version 1: the structures of docs/run-format.md.
//
//   header (1024 bytes) | blocks (framed like scratch blocks: streaming/spill/spill_block.h)
//
// The concatenated payloads of the blocks are a sequence of sections, each of which begins at a
// multiple of 64 bytes: the levels, bricks first, then the roots, the ranges and, if there are
// layers, their table.
#pragma once

#include <cstddef>
#include <cstdint>

#include <span>
#include <vector>

#include "streaming/file/checksum.h"
#include "streaming/spill/spill_block.h"

namespace svdag {

constexpr unsigned char kRunMagic[8] = {0x89, 'S', 'V', 'R', 'U', 'N', '\r', '\n'};
constexpr uint32_t kRunVersion = 1;
constexpr uint32_t kRunLevels = 19;         // levels 0 .. L-2, L <= 20
constexpr uint32_t kRunBlockBytes = 65536;  // with its frame; the last block may be shorter
constexpr uint64_t kRunPayload = kRunBlockBytes - kSpillHeader;
constexpr uint64_t kRunAlignment = 64;         // of sections; divides kRunPayload
constexpr uint64_t kMaxRunKeys = 0xfffffffeU;  // per level

struct RunHeader {
  unsigned char magic[8];
  uint32_t version;
  uint32_t header_bytes;  // 1024
  uint32_t levels;        // L
  uint32_t fraction;      // F
  uint32_t rule;          // Rule
  uint32_t grid_kind;     // Grid::Kind
  double origin[3];       // world position of the grid's corner (kBox) or plane 0 (kOrigin); else 0
  double voxel_size;
  int64_t k0[3];         // plane number of the corner; kBox: 0
  uint32_t bounded;      // 1 if voxels outside the selection are left empty by request
  uint32_t block_bytes;  // kRunBlockBytes
  uint32_t selection_min[3];
  uint32_t selection_max[3];  // exclusive
  uint64_t ranges;            // number of Morton ranges of the part
  uint64_t run;         // run number: low word of XXH3-128 over the fields before and the ranges;
                        // also in the frame of each block
  uint64_t voxels;      // set voxels
  double largest_snap;  // in voxels, the largest move of a coordinate by the snap
  uint64_t roots;       // number of non-empty tops of the part
  uint64_t keys[kRunLevels];  // [k]: number of keys of level k; 0 for unused levels
  uint64_t file_bytes;
  uint64_t content_hash[2];  // XXH3-128 over the blocks' checksums and the header (hash and
                             // checksum as 0)
  double transform[12];      // of the scene into the world, 3x4, row by row; zeros: the identity
  // The layers; zeros in a run without.
  uint64_t layers_bytes;
  uint32_t layer_count;
  uint32_t layer_kind;          // LayerKind
  uint32_t has_union;           // 1: there are roots of the union
  uint32_t padding;             // zero
  unsigned char reserved[560];  // zero
  uint64_t header_checksum;     // XXH3-64 of the 1016 bytes before
};

struct StoredRoot {
  uint64_t code;           // Morton code of the top, at its level
  uint32_t level_and_set;  // level, and 256 times its set: 0 the union, 1 + i layer i
  uint32_t rank;
};

struct StoredRange {
  uint64_t begin, end;
};

static_assert(offsetof(RunHeader, origin) == 32);
static_assert(offsetof(RunHeader, run) == 128);
static_assert(offsetof(RunHeader, keys) == 160);
static_assert(offsetof(RunHeader, content_hash) == 320);
static_assert(offsetof(RunHeader, header_checksum) == 1016);
static_assert(sizeof(RunHeader) == 1024 && sizeof(StoredRoot) == 16 && sizeof(StoredRange) == 16);
static_assert(kRunPayload % kRunAlignment == 0);

// A range of bytes of the payload.
struct RunSection {
  uint64_t begin = 0, end = 0;
  uint64_t bytes() const { return end - begin; }
};

// The sections of a run, computed from the counts of its header. Requires levels of 3 .. 20 and
// counts that are limited by the size of a real file (below 2^48).
struct RunLayout {
  explicit RunLayout(const RunHeader& header);

  RunSection levels[kRunLevels];  // [k] is level k
  RunSection roots, ranges, layers;
  uint64_t payload = 0, blocks = 0, file_bytes = 0;
};

// The run number, which identifies grid, rule and part.
uint64_t run_number(const RunHeader& header, std::span<const StoredRange> ranges);
// The content hash; `blocks` has hashed the checksums of all blocks.
Hash128 content_hash_of(RunHeader header, Hasher128* blocks);
uint64_t checksum_of(const RunHeader& header);

}  // namespace svdag
