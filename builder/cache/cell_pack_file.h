// The file of a pack of cells (builder/cache/cell_pack.h).
//
//   header | bricks | nodes of height 3, 4, ... | entries | checksums
//
// Nodes are stored by height instead of level (a node of height h covers 2^h voxels a side, bricks
// have height 2), so that a pack serves grids of any resolution. Each height is sorted and closed
// like a level of a run (builder/reduce/run.h): children are 1 + rank in the height below. An entry
// maps a key to the node that is its sub-DAG, or to no node if the cell is empty.
//
// The payload, between header and checksums, is written and read in order, in blocks of 64 KiB with
// a checksum each.
//
// Rejected: packs as .run files with keys beside their roots (a run has the levels of one grid, its
// roots are the tops of a part of it, and its reader reads whole levels, not chosen cells).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "builder/cache/cell_store.h"
#include "io/brick.h"
#include "io/dag/write/node_key.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/file.h"

namespace svdag {

constexpr uint64_t kPackBegin = 256;  // offset of the first block in the file
constexpr uint64_t kPackBlock = 65536;
constexpr uint64_t kPackAlignment = 64;  // of sections, relative to kPackBegin

// The bytes of a pack differ from those that were written. Any other Error (no file descriptor
// left, a file server that does not answer) does not mean that the pack is damaged.
class DamagedCellPack : public Error {
 public:
  DamagedCellPack(const std::string& path, const std::string& sentence,
                  std::optional<uint64_t> offset = {})
      : Error(ExitCode::kBadInput, sentence, path, offset) {}
};

constexpr uint64_t align_pack(uint64_t position) {
  return (position + kPackAlignment - 1) / kPackAlignment * kPackAlignment;
}

constexpr uint32_t kBrickHeight = 2;
constexpr uint32_t kNoNode = 0xffffffffU;

struct CellPackEntry {
  CellKey key;
  uint64_t voxels;
  uint32_t height;
  uint32_t rank;  // kNoNode: the cell is empty
};

struct CellPackHeader {
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
static_assert(sizeof(CellPackHeader) == kPackBegin && sizeof(CellPackEntry) == 48);

constexpr uint64_t pack_key_bytes(uint32_t height) {
  return height == kBrickHeight ? sizeof(Brick) : sizeof(NodeKey);
}

// Start of the section of `height`, relative to kPackBegin; that of kHeights holds the entries.
inline uint64_t pack_section(const CellPackHeader& header, uint32_t height) {
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

class CellPackWriter {
 public:
  explicit CellPackWriter(AtomicFile* file) : file_(file), block_(kPackBlock) {}
  void append(std::span<const std::byte> bytes);
  // Appends zeros up to the next possible start of a section.
  void align();
  // Writes the last block and the checksums; returns the file size.
  uint64_t finish();

 private:
  void flush();

  AtomicFile* file_;
  std::vector<std::byte> block_;
  size_t filled_ = 0;
  std::vector<uint64_t> checksums_;
};

// Passes bytes `begin` .. `end` (relative to kPackBegin) of `file` to `use`, in chunks. Chunks
// begin at multiples of 64 bytes if `begin` does. DamagedCellPack if a block does not match its
// checksum.
void read_cell_pack(const File& file, std::span<const uint64_t> checksums, uint64_t payload,
                    uint64_t begin, uint64_t end,
                    const std::function<void(std::span<std::byte>)>& use);

}  // namespace svdag
