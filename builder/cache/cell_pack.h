// A pack: the sub-DAGs of the cells that one worker baked, in one file of a cell cache.
//
// What is in it: builder/cache/pack_layout.h. What a bake takes of it:
// builder/cache/pack_extraction.h.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "builder/cache/cell_store.h"
#include "builder/cache/pack_layout.h"
#include "builder/reduce/baked_run.h"
#include "streaming/file/file.h"

namespace svdag {

// Writes the cells of `baked` that have keys, baked in a grid of `levels` levels, for packs that
// are read later; nothing if there are none. `runs` holds the run if it was spilled.
void write_pack(const std::string& path, const BakedRun& baked, int levels, SpillFile* runs,
                MemoryBudget* budget);

class Pack {
 public:
  // Reads the header. A DamagedPack (builder/cache/pack_blocks.h) if it is not sound.
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

  struct TakenCell {
    size_t entry;
    Cube cube;
  };
  // The run of what was taken into a grid of `levels` levels, of a pack that was proven. Spilled if
  // there is a target.
  BakedRun extract(std::vector<TakenCell> taken, int levels, MemoryBudget* budget,
                   const SpillTarget* target) const;

 private:
  // Reads the section of `height` in order, piece by piece.
  void read_height(const File& file, uint32_t height,
                   const std::function<void(std::span<std::byte>)>& use) const;

  std::string path_;
  PackHeader header_{};
  MemoryBudget::Reservation counted_;  // the next two
  std::vector<PackEntry> entries_;
  std::vector<uint64_t> checksums_;  // of the blocks
  File file_;
};

}  // namespace svdag
