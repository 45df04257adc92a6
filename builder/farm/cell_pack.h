// A pack: the sub-DAGs of the cells that one worker baked, in one file of a cell cache.
//
//   header | bricks | nodes of height 3, 4, ... | entries | checksums
//
// Heights instead of levels (a node of height h covers 2^h voxels a side, bricks have 2), so that a
// pack serves grids of any resolution. Each height is sorted and closed like a level of a run
// (builder/run.h): children are 1 + rank in the height below. An entry says which node is the
// sub-DAG of which key, or that nothing is set. The checksums are those of 64 KiB blocks.
//
// What a bake takes of a pack is a run again: what the taken nodes reach, which is marked from the
// top down and copied from the bricks up, with ranks for the old ranks. Both orders are the same,
// so nothing is sorted.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "builder/cell_store.h"
#include "builder/voxelize.h"
#include "streaming/file.h"

namespace svdag {

constexpr uint32_t kNoNode = 0xffffffffU;

struct PackEntry {
  CellKey key;
  uint64_t voxels;
  uint32_t height;
  uint32_t rank;  // kNoNode: nothing is set in the cell
};

struct PackHeader {
  static constexpr uint32_t kHeights = 21;

  char magic[8];
  uint32_t version;
  uint32_t unused;
  uint64_t keys[kHeights];  // [h]: of height h
  uint64_t entries;
  uint64_t file_bytes;
  unsigned char reserved[48];  // zero
  uint64_t checksum;           // XXH3-64 of all before
};

// Writes the cells of `baked` that have keys, baked in a grid of `levels` levels, for packs that
// are read later; nothing if there are none. `runs` holds the run if it was spilled.
void write_pack(const std::string& path, const BakedRun& baked, int levels, SpillFile* runs,
                MemoryBudget* budget);

class Pack {
 public:
  // Reads the header. A DamagedPack (builder/farm/pack_blocks.h) if it is not sound.
  explicit Pack(std::string path);

  const std::string& path() const { return path_; }
  uint64_t bytes() const { return header_.file_bytes; }
  // How many entries there are, and the memory that read_entries() takes.
  uint64_t entry_count() const { return header_.entries; }
  uint64_t index_bytes() const;
  // The memory that extract() takes at most, beside that of the run.
  uint64_t marks_bytes() const;

  // To be called once, before all below. A DamagedPack if they are not sound.
  void read_entries(MemoryBudget* budget);
  std::span<const PackEntry> entries() const { return entries_; }
  // Opens the file, for good, and reads it once to the end: a DamagedPack if a byte of it is not as
  // it was written, or its nodes are none that a run can have; an Error if it cannot be read.
  void prove();

  struct Taken {
    size_t entry;
    Cube cube;
  };
  // The run of what was taken into a grid of `levels` levels, of a pack that was proven. Spilled if
  // there is a target.
  BakedRun extract(std::vector<Taken> taken, int levels, MemoryBudget* budget,
                   const SpillTarget* target) const;

 private:
  std::string path_;
  PackHeader header_{};
  MemoryBudget::Reservation counted_;  // the next two
  std::vector<PackEntry> entries_;
  std::vector<uint64_t> checksums_;  // of the blocks
  File file_;
};

}  // namespace svdag
