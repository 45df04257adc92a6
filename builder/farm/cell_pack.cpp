#include "builder/farm/cell_pack.h"

#include <algorithm>
#include <cstring>

#include "builder/farm/pack_blocks.h"
#include "streaming/checksum.h"
#include "streaming/rank_bitmap.h"

namespace svdag {
namespace {

constexpr char kPackMagic[8] = {'s', 'v', 'c', 'e', 'l', 'l', 's', '\n'};
constexpr uint32_t kPackVersion = 1;
constexpr uint32_t kBrickHeight = 2;
constexpr uint32_t kHeights = PackHeader::kHeights;

static_assert(sizeof(PackHeader) == kPackBegin && sizeof(PackEntry) == 48);

uint64_t key_bytes(uint32_t height) {
  return height == kBrickHeight ? sizeof(Brick) : sizeof(NodeKey);
}

// Where the section of `height` begins; that of kHeights is the entries.
uint64_t begin_of(const PackHeader& header, uint32_t height) {
  uint64_t at = 0;
  for (uint32_t h = kBrickHeight; h < height; ++h)
    at = align_pack(at + header.keys[h] * key_bytes(h));
  return at;
}

uint64_t payload_of(const PackHeader& header) {
  return begin_of(header, kHeights) + header.entries * sizeof(PackEntry);
}

uint64_t blocks_of(const PackHeader& header) {
  return (payload_of(header) + kPackBlock - 1) / kPackBlock;
}

uint64_t checksum_of(const PackHeader& header) {
  return checksum64(std::as_bytes(std::span(&header, 1)).first(offsetof(PackHeader, checksum)));
}

template <class Key>
std::span<const Key> keys_in(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const Key*>(bytes.data()), bytes.size() / sizeof(Key)};
}

// Appends the keys of a level, wherever they are; returns how many there are.
template <class Key>
uint64_t append_level(const RunLevel<Key>& level, SpillFile* runs, MemoryBudget* budget,
                      PackBlockWriter* out) {
  out->align();
  if (!level.spilled) {
    out->append(std::as_bytes(std::span(level.keys)));
    return level.keys.size();
  }
  SpillReader reader(runs, *level.spilled, budget);
  for (auto block = reader.next(); !block.empty(); block = reader.next()) out->append(block);
  return level.spilled->bytes / sizeof(Key);
}

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

// Keys of one height, of which none is empty: what a merge relies on.
template <class Key>
class Ascending {
 public:
  explicit Ascending(const std::string& path) : path_(path) {}
  void add(const Key& key) {
    if (!(last_ < key)) throw DamagedPack(path_, "is damaged: its nodes do not ascend");
    last_ = key;
  }

 private:
  const std::string& path_;
  Key last_{};
};

// Copies what taken nodes reach out of a proven pack.
class Extraction {
 public:
  using Read =
      std::function<void(uint32_t height, const std::function<void(std::span<std::byte>)>&)>;

  Extraction(const PackHeader& header, const std::string& path, Read read, MemoryBudget* budget)
      : header_(header), path_(path), read_(std::move(read)), budget_(budget) {
    for (uint32_t h = 0; h < kHeights; ++h) marks_.emplace_back(budget, "marks of a pack");
  }

  void take(const PackEntry& entry) { marks_[entry.height].set(entry.rank); }

  Run run(int levels, const SpillTarget* target) {
    for (uint32_t h = kHeights - 1; h > kBrickHeight; --h) mark_children(h);
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
  uint32_t rank(const PackEntry& entry) const { return marks_[entry.height].rank(entry.rank); }

 private:
  void mark_children(uint32_t height) {
    uint32_t rank = 0;
    read_(height, [&](std::span<std::byte> bytes) {
      for (const NodeKey& key : keys_in<NodeKey>(bytes)) {
        if (!marks_[height].has(rank++)) continue;
        for (const uint32_t child : key) {
          SVDAG_ASSERT(child <= header_.keys[height - 1]);  // the pack was proven
          if (child != 0) marks_[height - 1].set(child - 1);
        }
      }
    });
  }

  template <class Key>
  void copy(uint32_t height, uint64_t count, int level, const SpillTarget* target,
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
  Brick translated(Brick brick, uint32_t) const { return brick; }
  NodeKey translated(NodeKey key, uint32_t height) const {
    for (uint32_t& child : key) child = child == 0 ? 0 : 1 + marks_[height - 1].rank(child - 1);
    return key;
  }

  const PackHeader& header_;
  const std::string& path_;
  Read read_;
  MemoryBudget* budget_;
  std::vector<RankBitmap> marks_;  // [height]
};

}  // namespace

void write_pack(const std::string& path, const BakedRun& baked, int levels, SpillFile* runs,
                MemoryBudget* budget) {
  if (baked.cells.empty()) return;
  AtomicFile file(path);
  PackHeader header{};
  std::memcpy(header.magic, kPackMagic, sizeof kPackMagic);
  header.version = kPackVersion;
  PackBlockWriter out(&file);
  header.keys[kBrickHeight] = append_level(baked.run.bricks, runs, budget, &out);
  for (int level = levels - 3; level >= 0; --level)
    header.keys[levels - level] = append_level(baked.run.nodes[size_t(level)], runs, budget, &out);
  out.align();
  for (const BakedCell& cell : baked.cells) {
    PackEntry entry{cell.key, cell.voxels, 0, kNoNode};
    if (cell.root != BakedCell::kNoRoot) {
      const CellRoot& root = baked.roots[cell.root];
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

Pack::Pack(std::string path) : path_(std::move(path)) {
  const File file = File::open_read(path_);
  const size_t read = file.read_some_at(0, std::as_writable_bytes(std::span(&header_, 1)));
  const uint64_t size = file.size();
  bool sound = read == sizeof header_ &&
               std::memcmp(header_.magic, kPackMagic, sizeof kPackMagic) == 0 &&
               header_.version == kPackVersion && header_.checksum == checksum_of(header_) &&
               header_.file_bytes == size && header_.entries <= size / sizeof(PackEntry);
  for (const uint64_t keys : header_.keys) sound = sound && keys <= size / sizeof(Brick);
  if (!sound || kPackBegin + payload_of(header_) + blocks_of(header_) * sizeof(uint64_t) != size)
    throw DamagedPack(path_, "is no pack of a cell cache, or damaged");
}

uint64_t Pack::index_bytes() const {
  return header_.entries * sizeof(PackEntry) + blocks_of(header_) * sizeof(uint64_t);
}

uint64_t Pack::marks_bytes() const {
  uint64_t bytes = 0;
  for (const uint64_t keys : header_.keys) bytes += RankBitmap::most_bytes(keys);
  return bytes;
}

void Pack::read_entries(MemoryBudget* budget) {
  const File file = File::open_read(path_);
  const uint64_t payload = payload_of(header_);
  counted_ = budget->reserve(index_bytes(), "entries of the cell cache");
  checksums_.resize(blocks_of(header_));
  file.read_at(kPackBegin + payload, std::as_writable_bytes(std::span(checksums_)));
  entries_.resize(header_.entries);
  std::byte* to = reinterpret_cast<std::byte*>(entries_.data());
  read_pack(file, checksums_, payload, begin_of(header_, kHeights), payload,
            [&](std::span<std::byte> bytes) {
              std::memcpy(to, bytes.data(), bytes.size());
              to += bytes.size();
            });
  for (const PackEntry& entry : entries_) {
    if (entry.rank != kNoNode && (entry.height < kBrickHeight || entry.height >= kHeights ||
                                  entry.rank >= header_.keys[entry.height]))
      throw DamagedPack(path_, "is damaged: an entry has no node");
  }
}

void Pack::prove() {
  if (file_.descriptor() >= 0) return;
  File file = File::open_read(path_);
  const auto read = [&](uint32_t height, const auto& use) {
    const uint64_t begin = begin_of(header_, height);
    read_pack(file, checksums_, payload_of(header_), begin,
              begin + header_.keys[height] * key_bytes(height), use);
  };
  Ascending<Brick> bricks(path_);
  read(kBrickHeight, [&](std::span<std::byte> bytes) {
    for (const Brick brick : keys_in<Brick>(bytes)) bricks.add(brick);
  });
  for (uint32_t h = kBrickHeight + 1; h < kHeights; ++h) {
    Ascending<NodeKey> nodes(path_);
    read(h, [&](std::span<std::byte> bytes) {
      for (const NodeKey& key : keys_in<NodeKey>(bytes)) {
        nodes.add(key);
        if (*std::max_element(key.begin(), key.end()) > header_.keys[h - 1])
          throw DamagedPack(path_, "is damaged: a child is outside of the pack");
      }
    });
  }
  file_ = std::move(file);
}

BakedRun Pack::extract(std::vector<Taken> taken, int levels, MemoryBudget* budget,
                       const SpillTarget* target) const {
  const auto range_of = [&](const Taken& t) { return morton_range(t.cube, levels); };
  std::sort(taken.begin(), taken.end(),
            [&](const Taken& a, const Taken& b) { return range_of(a).begin < range_of(b).begin; });
  const auto read = [&](uint32_t height, const std::function<void(std::span<std::byte>)>& use) {
    const uint64_t begin = begin_of(header_, height);
    read_pack(file_, checksums_, payload_of(header_), begin,
              begin + header_.keys[height] * key_bytes(height), use);
  };
  Extraction extraction(header_, path_, read, budget);
  for (const Taken& t : taken) {
    if (entries_[t.entry].rank != kNoNode) extraction.take(entries_[t.entry]);
  }
  BakedRun baked;
  baked.run = extraction.run(levels, target);
  for (const Taken& t : taken) {
    const PackEntry& entry = entries_[t.entry];
    append_range(&baked.finished, range_of(t));
    baked.voxels += entry.voxels;
    if (entry.rank == kNoNode) continue;
    SVDAG_ASSERT(int(entry.height) == levels - t.cube.level);
    baked.roots.push_back({morton(t.cube.coordinate), t.cube.level, 0, extraction.rank(entry)});
  }
  return baked;
}

}  // namespace svdag
