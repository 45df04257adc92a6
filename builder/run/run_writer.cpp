#include "builder/run/run_writer.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "io/dag/grid_fields.h"
#include "streaming/error.h"

namespace svdag {
namespace {

std::vector<StoredRange> stored(const std::vector<MortonRange>& ranges) {
  std::vector<StoredRange> out;
  for (const MortonRange& range : ranges) out.push_back({range.begin, range.end});
  return out;
}

// Sorts the layers by name; returns the roots with the new numbers.
std::vector<SubDagRoot> sort_layers(std::span<const SubDagRoot> roots, LayerTable* table) {
  std::vector<uint32_t> order(table->layers.size()), number(table->layers.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](uint32_t i) { return table->layers[i].name; });
  std::vector<Layer> sorted;
  for (uint32_t i = 0; i < order.size(); ++i) {
    number[order[i]] = i;
    sorted.push_back(table->layers[order[i]]);
    sorted.back().root = kNoRoot;
  }
  table->layers = std::move(sorted);
  std::vector<SubDagRoot> renumbered(roots.begin(), roots.end());
  for (SubDagRoot& root : renumbered) {
    const Subject subject = root.sets.subject;
    if (is_layer(subject)) root.sets = SubDagSets::only(subject_of(number[layer_of(subject)]));
  }
  return renumbered;
}

}  // namespace

RunWriter::RunWriter(const std::string& path, const Grid& grid, Rule rule, GridPart part)
    : file_(path), part_(std::move(part)), level_(grid.levels - 1) {
  static_assert(std::endian::native == std::endian::little, "the format is little-endian");
  std::memcpy(header_.magic, kRunMagic, sizeof kRunMagic);
  header_.version = kRunVersion;
  header_.header_bytes = sizeof(RunHeader);
  put_grid(grid, rule, &header_);
  header_.block_bytes = kRunBlockBytes;
  for (int a = 0; a < 3; ++a) header_.origin[a] = grid.origin[a];
  header_.ranges = part_.ranges().size();
  header_.run = run_number(header_, stored(part_.ranges()));
  file_.write_at(0, std::as_bytes(std::span(&header_, 1)));
}

void RunWriter::begin_level(int level) {
  SVDAG_ASSERT(level == level_ - 1 && level >= 0);
  align();
  level_ = level;
  last_ = {};
}

void RunWriter::encode(std::span<const Brick> bricks, LevelPiece* piece) const {
  piece->add_as_they_are(bricks);
}

void RunWriter::encode(std::span<const NodeKey> nodes, LevelPiece* piece) const {
  piece->add_as_they_are(nodes);
}

uint32_t RunWriter::append(LevelPiece* piece) {
  SVDAG_ASSERT(last_ < piece->first);
  last_ = piece->last;
  uint64_t& keys = header_.keys[level_];
  const uint64_t first = keys;
  keys += piece->indices.size();
  if (keys > kMaxRunKeys)
    throw Error(ExitCode::kOutput, "level " + std::to_string(level_) +
                                       " has more than 2^32 - 2 nodes, the limit of a run: "
                                       "lower the resolution or bake smaller parts");
  blocks_.append(piece->bytes, &piece->filled);
  return uint32_t(first);
}

// Sections are aligned and item sizes divide a payload, so no item straddles two blocks.
void RunWriter::append(const void* bytes, size_t size) {
  blocks_.append({static_cast<const std::byte*>(bytes), size}, &filled_);
  store(&filled_);
}

void RunWriter::store(FilledBlocks* filled) {
  filled->write_all([this](FilledBlock& block) {
    const uint32_t length = uint32_t(block.size - kSpillHeader);
    const uint64_t checksum = seal_block(block.bytes(), {header_.run, block.number, length});
    file_.write_at(sizeof header_ + block.number * kRunBlockBytes, block.bytes());
    return checksum;
  });
}

void RunWriter::align() {
  const size_t gap = (kRunAlignment - blocks_.position() % kRunAlignment) % kRunAlignment;
  static constexpr std::byte kZeros[kRunAlignment] = {};
  append(kZeros, gap);
}

void RunWriter::append_roots(std::span<const SubDagRoot> roots) {
  std::vector<SubDagRoot> sorted(roots.begin(), roots.end());
  const auto position = [this](const SubDagRoot& root) {
    return root.morton << 3 * (part_.levels() - root.level);
  };
  std::sort(sorted.begin(), sorted.end(), [&](const SubDagRoot& a, const SubDagRoot& b) {
    return std::pair(position(a), a.sets.subject) < std::pair(position(b), b.sets.subject);
  });
  for (const SubDagRoot& root : sorted) {
    SVDAG_ASSERT(part_.is_top(root.level, root.morton));
    const StoredRoot out = {root.morton, uint32_t(root.level) | root.sets.subject << 8, root.rank};
    append(&out, sizeof out);
  }
  header_.roots = sorted.size();
}

void RunWriter::append_layers(const LayerTable& layers) {
  header_.layer_kind = uint32_t(layers.kind);
  header_.layer_count = uint32_t(layers.layers.size());
  header_.has_union = layers.has_union;
  align();
  const std::vector<std::byte> bytes = encode_layers(layers);
  header_.layers_bytes = bytes.size();
  append(bytes.data(), bytes.size());
}

void RunWriter::finish(std::span<const SubDagRoot> roots, uint64_t voxels, double largest_snap,
                       LayerTable layers) {
  SVDAG_ASSERT(level_ == 0);
  header_.voxels = voxels;
  header_.largest_snap = largest_snap;
  align();
  append_roots(sort_layers(roots, &layers));
  align();
  for (const StoredRange& range : stored(part_.ranges())) append(&range, sizeof range);
  if (!layers.empty()) append_layers(layers);
  blocks_.finish(&filled_);
  store(&filled_);
  header_.file_bytes = RunLayout(header_).file_bytes;
  Hasher128 hasher;
  for (const uint64_t checksum : blocks_.checksums())
    hasher.update(std::as_bytes(std::span(&checksum, 1)));
  const Hash128 hash = content_hash_of(header_, &hasher);
  std::copy(hash.begin(), hash.end(), header_.content_hash);
  header_.header_checksum = checksum_of(header_);
  file_.write_at(0, std::as_bytes(std::span(&header_, 1)));
  file_.commit();
}

std::vector<uint64_t> RunWriter::key_counts() const {
  return {header_.keys, header_.keys + header_.levels - 1};
}

std::string RunWriter::content_hash() const {
  return to_hex(header_.content_hash);
}

}  // namespace svdag
