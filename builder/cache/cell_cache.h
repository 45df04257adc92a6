// The cell cache (`--cache DIR`): a folder of baked cells that later bakes reuse.
//
// The folder holds packs (builder/cache/cell_pack.h), one for each node table that a bake filled
// with new cells. A bake reads the entries of all packs when it begins, takes the cells that it
// meets, and adds packs of its own at its end. A pack gets a random name, by a rename once it is
// complete, so any number of bakes can share the folder.
//
// A pack is read completely before a cell is taken from it, and then stays open, since another bake
// may remove it. A damaged pack is removed. A pack that cannot be opened or read is skipped.
// So are packs beyond the number that may be open at once, and the least recently used packs if the
// entries of all do not fit in their share of the memory (builder/workspace/memory_shares.h).
//
// The folder is limited in bytes and in packs, since small packs are never joined and a bake reads
// each. Beyond a limit the least recently used packs are removed. Rejected: a file per cell
// (262,144 at 64K^3), a database (locks over NFS).
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "builder/cache/cell_pack.h"
#include "io/dag/format.h"
#include "streaming/file/file_folder.h"

namespace svdag {

struct CellCacheConfig {
  std::string folder;                       // created if missing, accessible to this user only
  uint64_t max_bytes = uint64_t(16) << 30;  // of all packs
  size_t max_packs = 4096;
  size_t max_open = 0;  // packs from which a bake takes cells; 0: by the file limit
};

class CellCache final : public CellStore {
 public:
  CellCache(const CellCacheConfig& config, const Grid& grid, Rule rule, MemoryBudget* budget);
  // Removes packs until the folder is within its limits.
  ~CellCache() override;

  CellKey key(const Cube& cube, const TriangleList& list, int32_t winding) const override;
  bool take(const CellKey& key, const Cube& cube, SubDagSets sets) override;
  void load_taken(const std::function<std::optional<SpillTarget>(uint64_t)>& target,
                  const std::function<void(BakedRun)>& use) override;
  // A failed write is not an error; counts() has the reason.
  void keep(const BakedRun& baked, SpillFile* runs) override;
  CellStoreCounts counts() const override { return counts_; }

 private:
  // Entry `entry` of packs_[pack].
  struct CellAddress {
    uint32_t pack, entry;
  };
  struct PackFile {
    std::filesystem::file_time_type used;
    std::string name;
    uint64_t bytes;
  };
  struct OpenPack {
    CellPack pack;
    std::vector<CellPack::TakenCell> taken;
    bool proven = false, unusable = false;
  };
  std::vector<PackFile> find_packs() const;
  void open_packs();
  void make_index();
  const CellKey& key_at(CellAddress address) const {
    return packs_[address.pack].pack.entries()[address.entry].key;
  }
  void trim() const;
  bool is_usable(OpenPack* open);
  void discard(const std::string& name) const;

  CellCacheConfig config_;
  Grid grid_;
  Rule rule_;
  MemoryBudget* budget_;
  Folder folder_;
  std::vector<OpenPack> packs_;
  size_t open_packs_ = 0;               // number of packs_ that are open
  MemoryBudget::Reservation counted_;   // of addresses_
  std::vector<CellAddress> addresses_;  // of all keys, sorted by key
  std::mutex mutex_;
  CellStoreCounts counts_;
};

}  // namespace svdag
