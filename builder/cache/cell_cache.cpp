#include "builder/cache/cell_cache.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <random>
#include <tuple>

#include "builder/cache/cell_key.h"
#include "builder/cache/cell_pack_file.h"
#include "builder/workspace/memory_shares.h"
#include "streaming/counts.h"

namespace svdag {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".cells";

std::string random_name() {
  std::random_device device;
  char name[17];
  std::snprintf(name, sizeof name, "%08x%08x", unsigned(device()), unsigned(device()));
  return std::string(name) + kExtension;
}

// Whether `name` is the name of a pack. Other files in the folder are left alone.
bool is_pack_name(const std::string& name) {
  return name.size() == 16 + std::strlen(kExtension) && name.ends_with(kExtension) &&
         name.find_first_not_of("0123456789abcdef") == 16;
}

// A quarter of the file descriptors of this process; the rest of the bake needs some too.
size_t packs_to_keep_open() {
  struct rlimit files;
  return ::getrlimit(RLIMIT_NOFILE, &files) == 0 ? size_t(files.rlim_cur / 4) : 0;
}

// For an Error that does not prove the pack damaged: rethrows a defect of the program (kInternal);
// otherwise returns, and the bake continues without the pack.
void rethrow_if_internal(const Error& error) {
  if (error.code() == ExitCode::kInternal) throw;
}

}  // namespace

CellCache::CellCache(const CellCacheConfig& config, const Grid& grid, Rule rule,
                     MemoryBudget* budget)
    : config_(config),
      grid_(grid),
      rule_(rule),
      budget_(budget),
      folder_(Folder::open_shared(config.folder)) {
  if (config_.max_open == 0) config_.max_open = packs_to_keep_open();
  open_packs();
}

CellCache::~CellCache() {
  try {
    trim();
  } catch (const std::exception&) {  // the next bake tries again
  }
}

// All packs in the folder, least recently used first.
std::vector<CellCache::PackFile> CellCache::find_packs() const {
  std::vector<PackFile> packs;
  for (const std::string& name : folder_.names()) {
    if (!is_pack_name(name)) continue;
    const fs::path path = fs::path(config_.folder) / name;
    std::error_code gone;  // another bake may remove packs too
    const auto used = fs::last_write_time(path, gone);
    const uint64_t bytes = gone ? 0 : fs::file_size(path, gone);
    if (!gone) packs.push_back({used, name, bytes});
  }
  std::sort(packs.begin(), packs.end(), [](const PackFile& a, const PackFile& b) {
    return std::tie(a.used, a.name) < std::tie(b.used, b.name);
  });
  return packs;
}

void CellCache::open_packs() {
  const MemoryShares shares(budget_->limit());
  uint64_t left = shares.cache_index, entries = 0;
  std::vector<PackFile> found = find_packs();
  std::reverse(found.begin(), found.end());
  for (const PackFile& file : found) {
    try {
      CellPack pack(config_.folder + "/" + file.name);
      const uint64_t bytes = pack.index_bytes() + pack.entry_count() * sizeof(CellAddress);
      if (bytes > left || pack.marks_bytes() > shares.cache_marks) {
        ++counts_.skipped_packs;
        continue;
      }
      pack.read_entries(budget_);
      packs_.push_back({std::move(pack), {}});
      left -= bytes;
      entries += packs_.back().pack.entry_count();
    } catch (const DamagedCellPack&) {
      discard(file.name);
    } catch (const Error& error) {
      rethrow_if_internal(error);
    }
  }
  counted_ = budget_->reserve(entries * sizeof(CellAddress), "index of the cell cache");
  addresses_.reserve(entries);
  make_index();
}

// Of equal keys, the one in the most recently used pack is kept.
void CellCache::make_index() {
  for (uint32_t p = 0; p < packs_.size(); ++p) {
    const uint32_t count = as_u32(packs_[p].pack.entry_count(), "cells of a pack");
    for (uint32_t e = 0; e < count; ++e) addresses_.push_back({p, e});
  }
  std::sort(addresses_.begin(), addresses_.end(), [this](CellAddress a, CellAddress b) {
    return std::tie(key_at(a).words, a.pack, a.entry) < std::tie(key_at(b).words, b.pack, b.entry);
  });
  const auto same = [this](CellAddress a, CellAddress b) { return key_at(a) == key_at(b); };
  addresses_.erase(std::unique(addresses_.begin(), addresses_.end(), same), addresses_.end());
}

CellKey CellCache::key(const Cube& cube, const TriangleList& list, int32_t winding) const {
  return cell_key(grid_, rule_, cube, list, winding);
}

void CellCache::discard(const std::string& name) const {
  try {
    folder_.remove(name);
  } catch (const Error&) {  // a read-only cache can still be used
  }
}

// Proves a pack before its first use and updates the time of last use of its file.
bool CellCache::is_usable(OpenPack* open) {
  if (open->proven || open->unusable) return open->proven;
  if (open_packs_ >= config_.max_open) return false;
  open->unusable = true;
  try {
    open->pack.prove();
    open->proven = true;
    ++open_packs_;
    std::error_code unused;  // a read-only cache can still be used
    fs::last_write_time(open->pack.path(), fs::file_time_type::clock::now(), unused);
  } catch (const DamagedCellPack&) {
    discard(fs::path(open->pack.path()).filename().string());
  } catch (const Error& error) {
    rethrow_if_internal(error);
  }
  return open->proven;
}

bool CellCache::take(const CellKey& key, const Cube& cube, SubDagSets sets) {
  const auto found = std::lower_bound(
      addresses_.begin(), addresses_.end(), key,
      [this](CellAddress address, const CellKey& k) { return key_at(address).words < k.words; });
  if (found == addresses_.end() || key_at(*found) != key) return false;
  const std::lock_guard lock(mutex_);
  OpenPack& open = packs_[found->pack];
  const CellPackEntry& entry = open.pack.entries()[found->entry];
  const bool fits = entry.rank == kNoNode || int(entry.height) == grid_.levels - cube.level;
  if (!fits || !is_usable(&open)) return false;
  open.taken.push_back({found->entry, cube, sets});
  ++counts_.hits;
  return true;
}

void CellCache::load_taken(const std::function<std::optional<SpillTarget>(uint64_t)>& target,
                           const std::function<void(BakedRun)>& use) {
  for (OpenPack& open : packs_) {
    if (open.taken.empty()) continue;
    const std::optional<SpillTarget> spill_target = target(open.pack.bytes());
    use(open.pack.extract(std::move(open.taken), grid_.levels, budget_,
                          spill_target ? &*spill_target : nullptr));
    open.taken.clear();
  }
}

void CellCache::keep(const BakedRun& baked, SpillFile* runs) {
  {
    const std::lock_guard lock(mutex_);
    if (!counts_.write_error.empty()) return;
  }
  try {
    write_cell_pack(config_.folder + "/" + random_name(), baked, grid_.levels, runs, budget_);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kOutput) throw;
    const std::lock_guard lock(mutex_);
    counts_.write_error = std::string("cannot write the cell cache: ") + error.what();
  }
}

void CellCache::trim() const {
  const std::vector<PackFile> packs = find_packs();
  uint64_t all = 0;
  for (const PackFile& pack : packs) all += pack.bytes;
  size_t left = packs.size();
  for (const PackFile& pack : packs) {
    if (all <= config_.max_bytes && left <= config_.max_packs) return;
    folder_.remove(pack.name);
    all -= pack.bytes;
    --left;
  }
}

}  // namespace svdag
