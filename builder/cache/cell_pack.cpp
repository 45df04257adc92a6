#include "builder/cache/cell_pack.h"

#include <algorithm>
#include <cstring>

#include "builder/cache/pack_extraction.h"
#include "streaming/file/checksum.h"
#include "streaming/memory/rank_bitmap.h"

namespace svdag {
namespace {

constexpr char kPackMagic[8] = {'s', 'v', 'c', 'e', 'l', 'l', 's', '\n'};
constexpr uint32_t kPackVersion = 1;
constexpr uint32_t kHeights = PackHeader::kHeights;

uint64_t payload_of(const PackHeader& header) {
  return pack_section(header, kHeights) + header.entries * sizeof(PackEntry);
}

uint64_t blocks_of(const PackHeader& header) {
  return (payload_of(header) + kPackBlock - 1) / kPackBlock;
}

uint64_t checksum_of(const PackHeader& header) {
  return checksum64(std::as_bytes(std::span(&header, 1)).first(offsetof(PackHeader, checksum)));
}

// Appends the keys of a level, from memory or from scratch; returns their number.
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

// Checks that the keys of one height ascend and are not empty, which a merge relies on.
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

Pack::Pack(std::string path) : path_(std::move(path)) {
  const File file = File::open_read(path_);
  const size_t read = file.read_some_at(0, std::as_writable_bytes(std::span(&header_, 1)));
  const uint64_t size = file.size();
  bool sound =
      read == sizeof header_ && std::memcmp(header_.magic, kPackMagic, sizeof kPackMagic) == 0;
  if (sound && header_.version != kPackVersion && header_.checksum == checksum_of(header_))
    throw Error(ExitCode::kBadInput, "is of another version of svdag",
                path_);  // not damaged: that version may use it
  sound = sound && header_.version == kPackVersion && header_.checksum == checksum_of(header_) &&
          header_.file_bytes == size && header_.entries <= size / sizeof(PackEntry);
  for (const uint64_t keys : header_.keys) sound = sound && keys <= size / sizeof(Brick);
  if (!sound || kPackBegin + payload_of(header_) + blocks_of(header_) * sizeof(uint64_t) != size)
    throw DamagedPack(path_, "is not a pack of a cell cache, or is damaged");
}

uint64_t Pack::index_bytes() const {
  return header_.entries * sizeof(PackEntry) + blocks_of(header_) * sizeof(uint64_t);
}

uint64_t Pack::marks_bytes() const {
  uint64_t bytes = 0;
  for (const uint64_t keys : header_.keys) bytes += RankBitmap::max_bytes(keys);
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
  read_pack(file, checksums_, payload, pack_section(header_, kHeights), payload,
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

void Pack::read_height(const File& file, uint32_t height,
                       const std::function<void(std::span<std::byte>)>& use) const {
  const uint64_t begin = pack_section(header_, height);
  read_pack(file, checksums_, payload_of(header_), begin,
            begin + header_.keys[height] * pack_key_bytes(height), use);
}

void Pack::prove() {
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
          throw DamagedPack(path_, "is damaged: a child is outside of the pack");
      }
    });
  }
  file_ = std::move(file);
}

BakedRun Pack::extract(std::vector<TakenCell> taken, int levels, MemoryBudget* budget,
                       const SpillTarget* target) const {
  const auto range_of = [&](const TakenCell& t) { return morton_range(t.cube, levels); };
  std::sort(taken.begin(), taken.end(), [&](const TakenCell& a, const TakenCell& b) {
    return range_of(a).begin < range_of(b).begin;
  });
  PackExtraction extraction(
      header_, [&](uint32_t height, const auto& use) { read_height(file_, height, use); }, budget);
  for (const TakenCell& t : taken) {
    if (entries_[t.entry].rank != kNoNode) extraction.take(entries_[t.entry]);
  }
  BakedRun baked;
  baked.run = extraction.run(levels, target);
  for (const TakenCell& t : taken) {
    const PackEntry& entry = entries_[t.entry];
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
