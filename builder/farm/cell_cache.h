// `--cache DIR`: cells that were baked before are taken from a folder instead of being baked.
//
// The folder holds packs (builder/farm/cell_pack.h), one for each table of nodes that a bake filled
// with new cells. A bake reads the entries of all packs when it begins, takes what it meets, and
// adds packs of its own at its end, each under a random name and complete from the moment that it
// has the name: any number of bakes may share the folder. A pack is read through before anything of
// it is taken; one that is damaged, or gone, is as if it had never been, and is removed. Beyond the
// folder's limits the packs that were not used for the longest time go first: one limit is of
// bytes, the other of packs, for small ones are never joined to larger ones and each costs a bake
// its reading. Rejected: a file per cell (262,144 at 64K^3), one data base (locks over NFS).
#pragma once

#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "builder/farm/cell_pack.h"
#include "io/dag/format.h"
#include "streaming/file_folder.h"

namespace svdag {

struct CellCacheConfig {
  std::string folder;                        // made, for this user alone, if it is not there
  uint64_t most_bytes = uint64_t(16) << 30;  // of all packs
  size_t most_packs = 4096;
};

class CellCache final : public CellStore {
 public:
  CellCache(const CellCacheConfig& config, const Grid& grid, Rule rule, MemoryBudget* budget);
  // Removes packs until the folder is within its limits.
  ~CellCache() override;

  CellKey key(const Cube& cube, const EntryList& list) const override;
  bool take(const CellKey& key, const Cube& cube) override;
  void taken(const std::function<std::optional<SpillTarget>(uint64_t)>& target,
             const std::function<void(BakedRun)>& use) override;
  // What cannot be written is not kept; complaint() says why.
  void keep(const BakedRun& baked, SpillFile* runs) override;
  uint64_t hits() const override { return hits_; }
  std::string complaint() const override { return complaint_; }

 private:
  struct Place {
    size_t pack, entry;
  };
  struct Open {
    Pack pack;
    std::vector<Pack::Taken> taken;
    bool proven = false, broken = false;
  };
  struct Hash {
    size_t operator()(const CellKey& key) const { return size_t(key.words[0]); }
  };
  void open_packs();
  void trim() const;
  bool usable(Open* open) const;
  void discard(const std::string& name, const Error& error) const;

  CellCacheConfig config_;
  Grid grid_;
  Rule rule_;
  MemoryBudget* budget_;
  Folder folder_;
  std::vector<Open> packs_;
  MemoryBudget::Reservation counted_;  // places_
  std::unordered_map<CellKey, Place, Hash> places_;
  std::mutex mutex_;
  uint64_t hits_ = 0;
  std::string complaint_;
};

}  // namespace svdag
