// A pack of cells: a file of a cell cache with the sub-DAGs of the cells of one node table
// (builder/cache/cell_pack_file.h).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "builder/cache/cell_pack_file.h"
#include "builder/cache/cell_store.h"
#include "builder/reduce/baked_run.h"
#include "streaming/file/file.h"

namespace svdag {

// Writes a pack with the cells of `baked` that have keys; writes nothing if there are none.
// `levels` is L of the grid; `runs` holds the run of `baked` if it is spilled.
void write_cell_pack(const std::string& path, const BakedRun& baked, int levels, SpillFile* runs,
                     MemoryBudget* budget);

class CellPack {
 public:
  // Reads the header. DamagedCellPack if it is invalid.
  explicit CellPack(std::string path);

  const std::string& path() const { return path_; }
  uint64_t bytes() const { return header_.file_bytes; }
  // Number of entries, and memory in bytes of read_entries().
  uint64_t entry_count() const { return header_.entries; }
  uint64_t index_bytes() const;
  // Largest memory of extract() in bytes, without that of the run.
  uint64_t marks_bytes() const;

  // Must be called once, before the functions below. DamagedCellPack if the entries are invalid.
  void read_entries(MemoryBudget* budget);
  std::span<const CellPackEntry> entries() const { return entries_; }
  // Opens the file, keeps it open, and reads it once to the end. DamagedCellPack if a byte differs
  // from what was written, or its nodes cannot be those of a run; another Error if it cannot be
  // read.
  void prove();

  struct TakenCell {
    size_t entry;
    Cube cube;
    SubDagSets sets;
  };
  // The taken cells as a run of a grid with `levels` levels; spilled if `target` is given. The pack
  // must be proven.
  BakedRun extract(std::vector<TakenCell> taken, int levels, MemoryBudget* budget,
                   const SpillTarget* target) const;

 private:
  // Reads the section of `height` in order and passes it to `use` in chunks.
  void read_height(const File& file, uint32_t height,
                   const std::function<void(std::span<std::byte>)>& use) const;

  std::string path_;
  CellPackHeader header_{};
  MemoryBudget::Reservation counted_;  // of the next two
  std::vector<CellPackEntry> entries_;
  std::vector<uint64_t> checksums_;  // of the blocks
  File file_;
};

}  // namespace svdag
