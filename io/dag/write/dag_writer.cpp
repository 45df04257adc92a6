#include "io/dag/write/dag_writer.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "io/dag/compact/compact_writer.h"
#include "io/dag/grid_fields.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint32_t kMaxNodeWords = 9;

// Writes the words of a node; returns their number. What is after them is overwritten.
uint32_t encode_node(const NodeKey& children, uint32_t* words) noexcept {
  uint32_t mask = 0, count = 1;
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t present = children[c] != 0;
    words[count] = children[c] - 1;  // overwritten by the next child if this one is absent
    mask |= present << c;
    count += present;
  }
  words[0] = mask;
  return count;
}

}  // namespace

DagWriter::DagWriter(const std::string& path, const Grid& grid, Rule rule,
                     std::optional<WorkRoom> compact, uint64_t max_words)
    : path_(path),
      compact_(std::move(compact)),
      output_(path),
      max_words_(max_words),
      level_(grid.levels - 1) {
  static_assert(std::endian::native == std::endian::little, "the format is little-endian");
  std::memcpy(header_.magic, kMagic, sizeof kMagic);
  header_.version = version_of(Layout::kPlain, LayerKind::kNone);
  header_.header_bytes = sizeof(Header);
  put_grid(grid, rule, &header_);
  header_.section_count = uint32_t(grid.levels - 1);
  const Point corner = grid.corner();
  for (int a = 0; a < 3; ++a) {
    header_.corner[a] = corner[a];
    if (grid.kind == Grid::Kind::kOrigin) header_.origin[a] = grid.origin[a];
  }
}

void DagWriter::close_level() {
  if (level_ == int(header_.section_count)) return;  // no level was begun yet
  Section& section = header_.sections[level_];
  section.bytes = output_.position() - section.offset;
}

void DagWriter::begin_level(int level) {
  SVDAG_ASSERT(level == level_ - 1 && level >= 0);
  close_level();
  output_.align();
  level_ = level;
  words_ = 0;
  last_ = {};
  header_.sections[level].offset = output_.position();
}

void DagWriter::begin_key(const NodeKey& key) {
  SVDAG_ASSERT(last_ < key);
  last_ = key;
}

// Returns the index of the first of `words` further words (bricks).
uint32_t DagWriter::take_words(uint64_t words, uint64_t nodes) {
  if (words > max_words_ - words_)
    throw Error(ExitCode::kOutput,
                level_ + 2 == int(header_.levels)
                    ? "the scene needs more than 2^32 - 2 different bricks, which the format "
                      "cannot hold: lower the resolution"
                    : "level " + std::to_string(level_) +
                          " needs more than 2^32 - 2 words, which the format cannot hold: lower "
                          "the resolution");
  header_.sections[level_].nodes += nodes;
  const uint32_t index = words_;
  words_ += uint32_t(words);
  return index;
}

uint32_t DagWriter::add_brick(Brick brick) {
  SVDAG_ASSERT(level_ + 2 == int(header_.levels));
  begin_key(key_of(brick));
  const uint32_t index = take_words(1, 1);
  output_.append(std::as_bytes(std::span(&brick, 1)));
  return index;
}

uint32_t DagWriter::add_node(const NodeKey& children) {
  SVDAG_ASSERT(level_ + 2 < int(header_.levels));
  if (level_ > 0) {
    begin_key(children);
    return append_node(children);
  }
  roots_.push_back(children);
  return uint32_t(roots_.size() - 1);
}

uint32_t DagWriter::append_node(const NodeKey& children) {
  uint32_t words[kMaxNodeWords];
  const uint32_t count = encode_node(children, words);
  const uint32_t index = take_words(count, 1);
  output_.append(std::as_bytes(std::span(words, count)));
  return index;
}

void DagWriter::encode(std::span<const Brick> bricks, LevelPiece* piece) const {
  SVDAG_ASSERT(level_ + 2 == int(header_.levels));
  piece->add_as_they_are(bricks);
}

// A root stays as it is: its words are written when all roots are there.
void DagWriter::encode(std::span<const NodeKey> nodes, LevelPiece* piece) const {
  SVDAG_ASSERT(level_ + 2 < int(header_.levels));
  if (level_ == 0) return piece->add_as_they_are(nodes);
  constexpr size_t kWord = sizeof(uint32_t);
  size_t words = piece->bytes.size() / kWord;
  piece->bytes.resize((words + kMaxNodeWords * nodes.size()) * kWord);
  for (const NodeKey& node : nodes) {
    piece->add(node, words);
    words += encode_node(node, reinterpret_cast<uint32_t*>(piece->bytes.data()) + words);
  }
  piece->bytes.resize(words * kWord);
}

void DagWriter::encode(std::span<const unsigned char> masks, std::span<const uint32_t> children,
                       LevelPiece* piece) const {
  SVDAG_ASSERT(level_ + 2 < int(header_.levels) && level_ > 0 && piece->indices.empty());
  const size_t words = masks.size() + children.size();
  piece->bytes.resize(words * sizeof(uint32_t));
  piece->indices.resize(masks.size());
  uint32_t* const begin = reinterpret_cast<uint32_t*>(piece->bytes.data());
  uint32_t* word = begin;
  const uint32_t* child = children.data();
  for (size_t i = 0; i < masks.size(); ++i) {
    piece->indices[i] = uint32_t(word - begin);
    *word++ = masks[i];
    for (int c = 0; c < 8; ++c) word[c] = child[c] - 1;  // children of the next nodes: overwritten
    const size_t count = kChildCounts[masks[i]];
    word += count;
    child += count;
  }
  SVDAG_ASSERT(child + 8 == children.data() + children.size());
  piece->bytes.resize((words - 8) * sizeof(uint32_t));
  if (masks.empty()) return;
  piece->first = key_of(masks.front(), children.data());
  piece->last = key_of(masks.back(), child - kChildCounts[masks.back()]);
}

uint32_t DagWriter::append(LevelPiece* piece) {
  if (level_ == 0) {
    const size_t first = roots_.size();
    roots_.resize(first + piece->indices.size());
    std::memcpy(roots_.data() + first, piece->bytes.data(), piece->bytes.size());
    return uint32_t(first);
  }
  begin_key(piece->first);
  last_ = piece->last;
  const size_t item = level_ + 2 == int(header_.levels) ? sizeof(Brick) : sizeof(uint32_t);
  const uint32_t index = take_words(piece->bytes.size() / item, piece->indices.size());
  output_.blocks()->append(piece->bytes, &piece->filled);
  return index;
}

// Writes the roots, the default one first, the others ascending, and renumbers them in *layers.
void DagWriter::write_roots(LayerTable* layers) {
  SVDAG_ASSERT(!layers->empty() || roots_.size() <= 1);
  std::sort(layers->layers.begin(), layers->layers.end(),
            [](const Layer& a, const Layer& b) { return a.name < b.name; });
  if (roots_.empty()) return;
  std::vector<uint32_t> order(roots_.size()), number(roots_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::swap(order.front(), order[layers->default_root()]);
  std::sort(order.begin() + 1, order.end(),
            [this](uint32_t a, uint32_t b) { return roots_[a] < roots_[b]; });
  for (uint32_t i = 0; i < order.size(); ++i) {
    number[order[i]] = i;
    append_node(roots_[order[i]]);
  }
  for (Layer& layer : layers->layers) {
    if (layer.root != kNoRoot) layer.root = number[layer.root];
  }
}

void DagWriter::write_layers(LayerTable layers) {
  if (layers.empty()) return;
  header_.version = version_of(Layout::kPlain, layers.kind);
  header_.layer_kind = uint32_t(layers.kind);
  header_.layer_count = uint32_t(layers.layers.size());
  header_.has_union = layers.has_union;
  header_.voxels = layers.default_voxels(header_.voxels);
  output_.align();
  const std::vector<std::byte> bytes = encode_layers(layers);
  header_.layers_offset = output_.position();
  header_.layers_bytes = bytes.size();
  output_.append(bytes);
}

void DagWriter::complete(uint64_t voxels, double largest_snap, LayerTable layers) {
  SVDAG_ASSERT(level_ == 0);
  write_roots(&layers);
  close_level();
  header_.voxels = voxels;
  header_.largest_snap = largest_snap;
  write_layers(std::move(layers));
  output_.finish(&header_);
}

DagFile DagWriter::finish_unnamed(uint64_t voxels, double largest_snap, LayerTable layers,
                                  const std::string& shown_as) {
  complete(voxels, largest_snap, std::move(layers));
  return DagFile::map_valid(File::open_read(output_.open_name()), shown_as);
}

void DagWriter::finish(uint64_t voxels, double largest_snap, LayerTable layers,
                       const std::function<void(const Header&)>& check) {
  if (!compact_) {
    complete(voxels, largest_snap, std::move(layers));
    if (check) check(header_);
    return output_.commit();
  }
  SVDAG_ASSERT(!check);  // of plain files only
  const DagFile plain = finish_unnamed(voxels, largest_snap, std::move(layers), path_);
  header_ = write_compact(plain, path_, *compact_);
}

}  // namespace svdag
