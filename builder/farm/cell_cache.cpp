#include "builder/farm/cell_cache.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <random>

#include "builder/farm/cell_key.h"

namespace svdag {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".cells";

std::string random_name() {
  std::random_device device;
  char name[17];
  std::snprintf(name, sizeof name, "%08x%08x", unsigned(device()), unsigned(device()));
  return std::string(name) + kEnding;
}

}  // namespace

CellCache::CellCache(const CellCacheConfig& config, const Grid& grid, Rule rule,
                     MemoryBudget* budget)
    : config_(config),
      grid_(grid),
      rule_(rule),
      budget_(budget),
      folder_(Folder::open_shared(config.folder)) {
  open_packs();
}

CellCache::~CellCache() {
  try {
    trim();
  } catch (const std::exception&) {  // the next bake tries again
  }
}

void CellCache::open_packs() {
  constexpr uint64_t kPerPlace = 96;  // of a hash table's node and its share of the slots
  uint64_t entries = 0;
  std::vector<std::string> names = folder_.names();
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) {
    if (!name.ends_with(kEnding)) continue;
    try {
      packs_.push_back({Pack(config_.folder + "/" + name, budget_), {}});
      entries += packs_.back().pack.entries().size();
    } catch (const Error& error) {
      discard(name, error);
    }
  }
  counted_ = budget_->reserve(entries * kPerPlace, "the cell cache");
  places_.reserve(entries);
  for (size_t p = 0; p < packs_.size(); ++p) {
    const auto list = packs_[p].pack.entries();
    for (size_t e = 0; e < list.size(); ++e) places_.try_emplace(list[e].key, Place{p, e});
  }
}

CellKey CellCache::key(const Cube& cube, const EntryList& list) const {
  return cell_key(grid_, rule_, cube, list);
}

// What to do about a pack that cannot be used. One that a file server cannot give just now may be
// good another time.
void CellCache::discard(const std::string& name, const Error& error) const {
  if (error.code() == ExitCode::kOutput) return;
  if (error.code() != ExitCode::kBadInput) throw error;
  folder_.remove(name);
}

// Proves a pack before its first use; its file is marked as used.
bool CellCache::usable(Open* open) const {
  if (open->proven || open->broken) return open->proven;
  try {
    open->pack.prove();
    open->proven = true;
    std::error_code ignored;  // a cache that cannot be written to serves all the same
    fs::last_write_time(open->pack.path(), fs::file_time_type::clock::now(), ignored);
  } catch (const Error& error) {
    open->broken = true;
    discard(fs::path(open->pack.path()).filename().string(), error);
  }
  return open->proven;
}

bool CellCache::take(const CellKey& key, const Cube& cube) {
  const auto found = places_.find(key);
  if (found == places_.end()) return false;
  const std::lock_guard lock(mutex_);
  Open& open = packs_[found->second.pack];
  const PackEntry& entry = open.pack.entries()[found->second.entry];
  const bool fits = entry.rank == kNoNode || int(entry.height) == grid_.levels - cube.level;
  if (!fits || !usable(&open)) return false;
  open.taken.push_back({found->second.entry, cube});
  ++hits_;
  return true;
}

void CellCache::taken(const std::function<std::optional<SpillTarget>(uint64_t)>& target,
                      const std::function<void(BakedRun)>& use) {
  for (Open& open : packs_) {
    if (open.taken.empty()) continue;
    const std::optional<SpillTarget> place = target(open.pack.bytes());
    use(open.pack.extract(std::move(open.taken), grid_.levels, budget_, place ? &*place : nullptr));
    open.taken.clear();
  }
}

void CellCache::keep(const BakedRun& baked, SpillFile* runs) {
  {
    const std::lock_guard lock(mutex_);
    if (!complaint_.empty()) return;
  }
  try {
    write_pack(config_.folder + "/" + random_name(), baked, grid_.levels, runs, budget_);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kOutput) throw;
    const std::lock_guard lock(mutex_);
    complaint_ = std::string("the cell cache is not written: ") + error.what();
  }
}

void CellCache::trim() const {
  struct Found {
    fs::file_time_type used;
    std::string name;
    uint64_t bytes;
  };
  std::vector<Found> packs;
  uint64_t all = 0;
  for (const std::string& name : folder_.names()) {
    if (!name.ends_with(kEnding)) continue;
    const fs::path path = fs::path(config_.folder) / name;
    std::error_code gone;  // another bake may trim, too
    const Found found{fs::last_write_time(path, gone), name, fs::file_size(path, gone)};
    if (gone) continue;
    packs.push_back(found);
    all += found.bytes;
  }
  std::sort(packs.begin(), packs.end(),
            [](const Found& a, const Found& b) { return a.used < b.used; });
  size_t left = packs.size();
  for (const Found& pack : packs) {
    if (all <= config_.most_bytes && left <= config_.most_packs) return;
    folder_.remove(pack.name);
    all -= pack.bytes;
    --left;
  }
}

}  // namespace svdag
