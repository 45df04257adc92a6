#include "verify/view/tile_file.h"

#include <zlib.h>

#include <cstring>
#include <new>
#include <set>

namespace svdag {
namespace {

constexpr uint32_t kTileMagic = 0x31545653;  // "SVT1"
constexpr size_t kFixedWords = 22;
constexpr int kGzip = MAX_WBITS + 16;
constexpr size_t kMaxWordsOfTile = size_t(1) << 26;

using Words = std::vector<uint32_t>;

uint32_t checksum_of(std::span<const uint32_t> words) {
  uint32_t hash = 0x811c9dc5;
  for (const uint32_t word : words) hash = (hash ^ word) * 0x01000193;
  return hash;
}

// Empty if the bytes are not one gzip member with whole words.
Words decompressed(std::span<const std::byte> bytes) {
  Words words(std::min(kMaxWordsOfTile, bytes.size() * 258 + 64));
  z_stream state = {};
  if (inflateInit2(&state, kGzip) != Z_OK) throw std::bad_alloc();
  state.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
  state.avail_in = uInt(bytes.size());
  state.next_out = reinterpret_cast<Bytef*>(words.data());
  state.avail_out = uInt(4 * words.size());
  const bool whole = inflate(&state, Z_FINISH) == Z_STREAM_END && state.avail_in == 0;
  const uLong size = state.total_out;
  inflateEnd(&state);
  words.resize(whole && size % 4 == 0 ? size / 4 : 0);
  return words;
}

// Takes words from the front.
class WordReader {
 public:
  explicit WordReader(std::span<const uint32_t> words) : left_(words) {}
  bool has(size_t count) const { return count <= left_.size(); }
  bool empty() const { return left_.empty(); }
  uint32_t take() { return take(1)[0]; }
  std::span<const uint32_t> take(size_t count) {
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }

 private:
  std::span<const uint32_t> left_;
};

// Checks references: each offset is a node's, and each node except the root is referred to.
bool has_valid_nodes(const DagTile& tile) {
  std::set<uint32_t> referred = {0};
  for (size_t depth = 0; depth < tile.sections.size(); ++depth) {
    const Words& section = tile.sections[depth];
    std::set<uint32_t> starts, next;
    std::set<Words> contents;
    const bool bricks = depth + 1 == tile.sections.size();
    for (size_t at = 0; at < section.size();) {
      starts.insert(uint32_t(at));
      const size_t children = bricks ? 1 : size_t(popcount8(section[at]));
      if (at + 1 + children > section.size()) return false;
      const Words node(section.begin() + long(at), section.begin() + long(at + 1 + children));
      if (!contents.insert(node).second) return false;
      if (bricks ? (node[0] | node[1]) == 0 : node[0] == 0 || node[0] > 0xff) return false;
      if (!bricks) next.insert(node.begin() + 1, node.end());
      at += 1 + children;
    }
    if (starts != referred) return false;
    referred = std::move(next);
  }
  return true;
}

bool has_valid_layers(const DagTile& tile) {
  std::set<uint32_t> sets;
  std::set<uint32_t> nodes;
  const auto add = [&](uint32_t value) {
    if (value == kNoLayerSet) return true;
    return value & kLayerSet
               ? (sets.insert(value & ~kLayerSet), (value & ~kLayerSet) < tile.layer_sets.size())
               : (nodes.insert(value), value % 8 == 0 && value < tile.layer_nodes.size());
  };
  if (!add(tile.layer_root) || tile.layer_nodes.size() % 8 != 0) return false;
  std::set<Words> contents;
  for (size_t at = 0; at < tile.layer_nodes.size(); at += 8) {
    const Words node(tile.layer_nodes.begin() + long(at), tile.layer_nodes.begin() + long(at + 8));
    if (!contents.insert(node).second) return false;
    // Children are completed first, so references lead backwards and end.
    for (const uint32_t value : node) {
      if (!add(value) || ((value & kLayerSet) == 0 && value >= at)) return false;
    }
  }
  for (const auto& members : tile.layer_sets) {
    for (size_t i = 1; i < members.size(); ++i) {
      if (members[i - 1] >= members[i]) return false;
    }
  }
  return nodes.size() == tile.layer_nodes.size() / 8 && sets.size() == tile.layer_sets.size() &&
         std::set(tile.layer_sets.begin(), tile.layer_sets.end()).size() == sets.size();
}

}  // namespace

std::string compressed(std::span<const uint32_t> words) {
  z_stream state = {};
  if (deflateInit2(&state, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string out(deflateBound(&state, uLong(4 * words.size())), '\0');
  state.next_in = reinterpret_cast<Bytef*>(const_cast<uint32_t*>(words.data()));  // not written to
  state.avail_in = uInt(4 * words.size());
  state.next_out = reinterpret_cast<Bytef*>(out.data());
  state.avail_out = uInt(out.size());
  deflate(&state, Z_FINISH);
  out.resize(state.total_out);
  deflateEnd(&state);
  return out;
}

Words words_of(const DagTile& tile) {
  Words words = {kTileMagic,
                 0,
                 uint32_t(tile.sections.size() + 1),
                 tile.layer_root,
                 uint32_t(tile.layer_nodes.size()),
                 0};
  for (const uint64_t id : tile.finer)
    words.insert(words.end(), {uint32_t(id), uint32_t(id >> 32)});
  for (const Words& section : tile.sections) words.push_back(uint32_t(section.size()));
  for (const Words& section : tile.sections)
    words.insert(words.end(), section.begin(), section.end());
  words.insert(words.end(), tile.layer_nodes.begin(), tile.layer_nodes.end());
  for (const Words& members : tile.layer_sets) {
    words.push_back(uint32_t(members.size()));
    words.insert(words.end(), members.begin(), members.end());
    words[5] += uint32_t(1 + members.size());
  }
  words[1] = checksum_of(std::span(words).subspan(2));
  return words;
}

std::string encode_tile(const DagTile& tile) {
  return compressed(words_of(tile));
}

std::optional<DagTile> decode_tile(std::span<const std::byte> bytes) {
  return tile_of_words(decompressed(bytes));
}

std::optional<DagTile> tile_of_words(std::span<const uint32_t> words) {
  if (words.size() < kFixedWords || words[0] != kTileMagic || words[2] < 3 ||
      words[2] > kTileLevels || words[1] != checksum_of(words.subspan(2)))
    return {};
  DagTile tile;
  tile.sections.resize(words[2] - 1);
  tile.layer_root = words[3];
  for (size_t c = 0; c < 8; ++c)
    tile.finer[c] = words[6 + 2 * c] | uint64_t(words[7 + 2 * c]) << 32;
  WordReader reader(words.subspan(kFixedWords));
  if (!reader.has(tile.sections.size())) return {};
  for (Words& section : tile.sections) {
    section.resize(std::min<size_t>(reader.take(), words.size() + 1));
  }
  for (Words& section : tile.sections) {
    if (!reader.has(section.size())) return {};
    const auto taken = reader.take(section.size());
    section.assign(taken.begin(), taken.end());
  }
  if (!reader.has(words[4])) return {};
  const auto nodes = reader.take(words[4]);
  tile.layer_nodes.assign(nodes.begin(), nodes.end());
  if (!reader.has(words[5])) return {};
  WordReader sets(reader.take(words[5]));
  while (!sets.empty()) {
    const uint32_t count = sets.take();
    if (!sets.has(count)) return {};
    const auto members = sets.take(count);
    tile.layer_sets.emplace_back(members.begin(), members.end());
  }
  if (!reader.empty() || !has_valid_nodes(tile) || !has_valid_layers(tile)) return {};
  return tile;
}

}  // namespace svdag
