#include "builder/cache/cell_pack.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <optional>

#include "streaming/file/checksum.h"
#include "streaming/memory/rank_bitmap.h"
#include "streaming/spill/spill_file.h"

namespace svdag {
namespace {

constexpr char kPackMagic[8] = {'s', 'v', 'c', 'e', 'l', 'l', 's', '\n'};
constexpr uint32_t kPackVersion = 1;
constexpr uint32_t kHeights = CellPackHeader::kHeights;

uint64_t payload_of(const CellPackHeader& header) {
  return pack_section(header, kHeights) + header.entries * sizeof(CellPackEntry);
}

uint64_t blocks_of(const CellPackHeader& header) {
  return (payload_of(header) + kPackBlock - 1) / kPackBlock;
}

uint64_t checksum_of(const CellPackHeader& header) {
  return checksum64(std::as_bytes(std::span(&header, 1)).first(offsetof(CellPackHeader, checksum)));
}

// Appends the keys of a level, from memory or from scratch; returns their number.
template <class Key>
uint64_t append_level(const RunLevel<Key>& level, SpillFile* runs, MemoryBudget* budget,
                      CellPackWriter* out) {
  out->align();
  if (!level.spilled) {
    out->append(std::as_bytes(std::span(level.keys)));
    return level.keys.size();
  }
  SpillReader reader(runs, *level.spilled, budget);
  for (auto block = reader.next(); !block.empty(); block = reader.next()) out->append(block);
  return level.spilled->bytes / sizeof(Key);
}

// Checks that the keys of one height ascend and are not empty, which a merge relies on.
template <class Key>
class Ascending {
 public:
  explicit Ascending(const std::string& path) : path_(path) {}
  void add(const Key& key) {
    if (!(last_ < key)) throw DamagedCellPack(path_, "is damaged: its nodes do not ascend");
    last_ = key;
  }

 private:
  const std::string& path_;
  Key last_{};
};

// Collects the keys of one level of a run, in memory or in a stream.
template <class Key>
class LevelWriter {
 public:
  LevelWriter(RunLevel<Key>* level, uint64_t count, int number, MemoryBudget* budget,
              const SpillTarget* target)
      : level_(level) {
    if (target != nullptr) {
      writer_.emplace(target->file, target->first_stream + uint64_t(number), budget);
    } else {
      level->reservation = budget->reserve(count * sizeof(Key), "cells of the cache");
      level->keys.reserve(count);
    }
  }
  void add(const Key& key) {
    if (writer_) {
      writer_->append(std::as_bytes(std::span(&key, 1)));
    } else {
      level_->keys.push_back(key);
    }
  }
  void finish() {
    if (writer_) level_->spilled = writer_->finish();
  }

 private:
  RunLevel<Key>* level_;
  std::optional<SpillWriter> writer_;
};

// Extracts the cells that a bake takes from a pack as a run.
//
// The nodes that the taken ones reach are marked from the top down, then copied from the bricks up,
// with new ranks. Old and new ranks have the same order, so nothing is sorted.
class CellExtraction {
 public:
  // Passes the section of a height to the second argument, in order and in chunks.
  using Read =
      std::function<void(uint32_t height, const std::function<void(std::span<std::byte>)>&)>;

  // The pack must be proven; `header` must outlive this object.
  CellExtraction(const CellPackHeader& header, Read read, MemoryBudget* budget);

  // Takes an entry; all must be taken before run().
  void take(const CellPackEntry& entry) { marks_[entry.height].set(entry.rank); }
  // The run of a grid with `levels` levels; spilled if `target` is given.
  Run run(int levels, const SpillTarget* target);
  // The rank in the run of a taken entry. After run().
  uint32_t rank(const CellPackEntry& entry) const { return marks_[entry.height].rank(entry.rank); }

 private:
  void mark_children(uint32_t height);
  template <class Key>
  void copy(uint32_t height, uint64_t count, int level, const SpillTarget* target,
            RunLevel<Key>* out);
  Brick translated(Brick brick, uint32_t) const { return brick; }
  NodeKey translated(NodeKey key, uint32_t height) const;

  const CellPackHeader& header_;
  Read read_;
  MemoryBudget* budget_;
  std::vector<RankBitmap> marks_;  // [height]
};

CellExtraction::CellExtraction(const CellPackHeader& header, Read read, MemoryBudget* budget)
    : header_(header), read_(std::move(read)), budget_(budget) {
  for (uint32_t h = 0; h < CellPackHeader::kHeights; ++h)
    marks_.emplace_back(budget, "marks of a pack");
}

Run CellExtraction::run(int levels, const SpillTarget* target) {
  for (uint32_t h = CellPackHeader::kHeights - 1; h > kBrickHeight; --h) mark_children(h);
  std::vector<uint64_t> counts;
  for (RankBitmap& marks : marks_) {
    marks.seal();
    counts.push_back(marks.count());
  }
  Run run;
  run.nodes.resize(size_t(levels - 2));
  copy(kBrickHeight, counts[kBrickHeight], levels - 2, target, &run.bricks);
  for (int level = levels - 3; level >= 0; --level) {
    const uint32_t h = uint32_t(levels - level);
    copy(h, counts[h], level, target, &run.nodes[size_t(level)]);
  }
  return run;
}

void CellExtraction::mark_children(uint32_t height) {
  uint32_t rank = 0;
  read_(height, [&](std::span<std::byte> bytes) {
    for (const NodeKey& key : keys_in<NodeKey>(bytes)) {
      if (!marks_[height].has(rank++)) continue;
      for (const uint32_t child : key) {
        SVDAG_ASSERT(child <= header_.keys[height - 1]);  // prove() checked it
        if (child != 0) marks_[height - 1].set(child - 1);
      }
    }
  });
}

template <class Key>
void CellExtraction::copy(uint32_t height, uint64_t count, int level, const SpillTarget* target,
                          RunLevel<Key>* out) {
  LevelWriter<Key> writer(out, count, level, budget_, target);
  uint32_t rank = 0;
  if (count > 0) {
    read_(height, [&](std::span<std::byte> bytes) {
      for (const Key& key : keys_in<Key>(bytes)) {
        if (marks_[height].has(rank++)) writer.add(translated(key, height));
      }
    });
  }
  writer.finish();
}

NodeKey CellExtraction::translated(NodeKey key, uint32_t height) const {
  for (uint32_t& child : key) child = child == 0 ? 0 : 1 + marks_[height - 1].rank(child - 1);
  return key;
}

}  // namespace

void write_cell_pack(const std::string& path, const BakedRun& baked, int levels, SpillFile* runs,
                     MemoryBudget* budget) {
  if (baked.cells.empty()) return;
  AtomicFile file(path);
  CellPackHeader header{};
  std::memcpy(header.magic, kPackMagic, sizeof kPackMagic);
  header.version = kPackVersion;
  CellPackWriter out(&file);
  header.keys[kBrickHeight] = append_level(baked.run.bricks, runs, budget, &out);
  for (int level = levels - 3; level >= 0; --level)
    header.keys[levels - level] = append_level(baked.run.nodes[size_t(level)], runs, budget, &out);
  out.align();
  for (const BakedCell& cell : baked.cells) {
    CellPackEntry entry{cell.key, cell.voxels, 0, kNoNode};
    if (cell.root != BakedCell::kNoRoot) {
      const SubDagRoot& root = baked.roots[cell.root];
      entry.height = uint32_t(levels - root.level);
      entry.rank = root.rank;
    }
    out.append(std::as_bytes(std::span(&entry, 1)));
  }
  header.entries = baked.cells.size();
  header.file_bytes = out.finish();
  header.checksum = checksum_of(header);
  file.write_at(0, std::as_bytes(std::span(&header, 1)));
  file.commit();
}

CellPack::CellPack(std::string path) : path_(std::move(path)) {
  const File file = File::open_read(path_);
  const size_t read = file.read_some_at(0, std::as_writable_bytes(std::span(&header_, 1)));
  const uint64_t size = file.size();
  bool sound =
      read == sizeof header_ && std::memcmp(header_.magic, kPackMagic, sizeof kPackMagic) == 0;
  if (sound && header_.version != kPackVersion && header_.checksum == checksum_of(header_))
    throw Error(ExitCode::kBadInput, "is of another version of svdag",
                path_);  // not damaged: that version may use it
  sound = sound && header_.version == kPackVersion && header_.checksum == checksum_of(header_) &&
          header_.file_bytes == size && header_.entries <= size / sizeof(CellPackEntry);
  for (const uint64_t keys : header_.keys) sound = sound && keys <= size / sizeof(Brick);
  if (!sound || kPackBegin + payload_of(header_) + blocks_of(header_) * sizeof(uint64_t) != size)
    throw DamagedCellPack(path_, "is not a pack of a cell cache, or is damaged");
}

uint64_t CellPack::index_bytes() const {
  return header_.entries * sizeof(CellPackEntry) + blocks_of(header_) * sizeof(uint64_t);
}

uint64_t CellPack::marks_bytes() const {
  uint64_t bytes = 0;
  for (const uint64_t keys : header_.keys) bytes += RankBitmap::max_bytes(keys);
  return bytes;
}

void CellPack::read_entries(MemoryBudget* budget) {
  const File file = File::open_read(path_);
  const uint64_t payload = payload_of(header_);
  counted_ = budget->reserve(index_bytes(), "entries of the cell cache");
  checksums_.resize(blocks_of(header_));
  file.read_at(kPackBegin + payload, std::as_writable_bytes(std::span(checksums_)));
  entries_.resize(header_.entries);
  std::byte* to = reinterpret_cast<std::byte*>(entries_.data());
  read_cell_pack(file, checksums_, payload, pack_section(header_, kHeights), payload,
                 [&](std::span<std::byte> bytes) {
                   std::memcpy(to, bytes.data(), bytes.size());
                   to += bytes.size();
                 });
  for (const CellPackEntry& entry : entries_) {
    if (entry.rank != kNoNode && (entry.height < kBrickHeight || entry.height >= kHeights ||
                                  entry.rank >= header_.keys[entry.height]))
      throw DamagedCellPack(path_, "is damaged: an entry has no node");
  }
}

void CellPack::read_height(const File& file, uint32_t height,
                           const std::function<void(std::span<std::byte>)>& use) const {
  const uint64_t begin = pack_section(header_, height);
  read_cell_pack(file, checksums_, payload_of(header_), begin,
                 begin + header_.keys[height] * pack_key_bytes(height), use);
}

void CellPack::prove() {
  if (file_.descriptor() >= 0) return;
  File file = File::open_read(path_);
  Ascending<Brick> bricks(path_);
  read_height(file, kBrickHeight, [&](std::span<std::byte> bytes) {
    for (const Brick brick : keys_in<Brick>(bytes)) bricks.add(brick);
  });
  for (uint32_t h = kBrickHeight + 1; h < kHeights; ++h) {
    Ascending<NodeKey> nodes(path_);
    read_height(file, h, [&](std::span<std::byte> bytes) {
      for (const NodeKey& key : keys_in<NodeKey>(bytes)) {
        nodes.add(key);
        if (*std::max_element(key.begin(), key.end()) > header_.keys[h - 1])
          throw DamagedCellPack(path_, "is damaged: a child is outside of the pack");
      }
    });
  }
  file_ = std::move(file);
}

BakedRun CellPack::extract(std::vector<TakenCell> taken, int levels, MemoryBudget* budget,
                           const SpillTarget* target) const {
  const auto range_of = [&](const TakenCell& t) { return morton_range(t.cube, levels); };
  std::sort(taken.begin(), taken.end(), [&](const TakenCell& a, const TakenCell& b) {
    return range_of(a).begin < range_of(b).begin;
  });
  CellExtraction extraction(
      header_, [&](uint32_t height, const auto& use) { read_height(file_, height, use); }, budget);
  for (const TakenCell& t : taken) {
    if (entries_[t.entry].rank != kNoNode) extraction.take(entries_[t.entry]);
  }
  BakedRun baked;
  baked.run = extraction.run(levels, target);
  for (const TakenCell& t : taken) {
    const CellPackEntry& entry = entries_[t.entry];
    append_range(&baked.finished, range_of(t));
    count_voxels(t.sets, entry.voxels, &baked.voxels, &baked.layer_voxels);
    if (entry.rank == kNoNode) continue;
    SVDAG_ASSERT(int(entry.height) == levels - t.cube.level);
    baked.roots.push_back(
        {morton(t.cube.coordinate), t.cube.level, 0, extraction.rank(entry), t.sets});
  }
  return baked;
}

}  // namespace svdag
