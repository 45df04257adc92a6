#include "verify/view/tile.h"

#include <algorithm>
#include <bit>
#include <map>
#include <unordered_map>

#include "io/brick.h"

namespace svdag {
namespace {

using LayerNode = TileCube::LayerNode;

// The child mask of a brick.
uint32_t blocks_of(Brick brick) {
  uint32_t mask = 0;
  for (unsigned b = 0; b < 8; ++b) mask |= uint32_t((brick >> 8 * b & 0xff) != 0) << b;
  return mask;
}

// The children of a node, and their children, as the bits of a brick.
Brick brick_of_two_levels(const DagView& dag, uint32_t level, uint32_t node) {
  if (level == dag.brick_level()) return dag.bricks[node];
  Brick brick = 0;
  dag_for_children(dag, level, node, [&](unsigned c, uint32_t child) {
    const uint32_t mask = level + 1 == dag.brick_level() ? blocks_of(dag.bricks[child])
                                                         : dag_mask(dag, level + 1, child);
    brick |= Brick(mask) << 8 * c;
  });
  return brick;
}

bool is_full_node(const DagView& dag, uint32_t level, uint32_t node) {
  for (; level < dag.brick_level(); ++level) {
    if (dag_mask(dag, level, node) != 0xff) return false;
    const uint32_t first = dag_present_child(dag, level, node, 0);
    for (unsigned c = 1; c < 8; ++c) {
      if (dag_present_child(dag, level, node, c) != first) return false;
    }
    node = first;
  }
  return dag.bricks[node] == ~Brick(0);
}

}  // namespace

TileCutter::TileCutter(const DagFile& file, uint32_t level, uint32_t max_tile_levels)
    : level_(level),
      tile_levels_(std::min(level, max_tile_levels)),
      dag_(file.view()),
      has_union_(file.layers().has_union) {
  for (size_t i = 0; i < file.layers().layers.size(); ++i) layers_.push_back(file.view_of(i));
}

const DagView& TileCutter::view(const TileCube& cube, const LayerNode& node) const {
  return cube.level > 0 || node.layer == TileCube::kUnion ? dag_ : layers_[node.layer];
}

TileCube TileCutter::root() const {
  TileCube cube;
  for (uint32_t i = 0; i < layers_.size(); ++i) {
    if (!layers_[i].empty()) cube.nodes.push_back({i, 0});
  }
  if (has_union_ && !dag_.empty()) cube.nodes.push_back({TileCube::kUnion, 0});
  return cube;
}

TileCube TileCutter::octant(const TileCube& cube, unsigned c) const {
  TileCube result{cube.level + 1, {}};
  for (const LayerNode& node : cube.nodes) {
    const uint32_t child = dag_child(view(cube, node), cube.level, node.node, c);
    if (child != kNoChild) result.nodes.push_back({node.layer, child});
  }
  return result;
}

bool TileCutter::is_full(const TileCube& cube) const {
  for (const LayerNode& node : cube.nodes) {
    if (!is_full_node(view(cube, node), cube.level, node.node)) return false;
  }
  return true;
}

// Cuts one tile. Cubes with the same nodes are visited once.
class TileCutter::Cut {
 public:
  Cut(const TileCutter& cutter, const TileCube& cube)
      : cutter_(cutter), bricks_(cube.level + cutter.tile_levels() - 2), top_(cube.level) {
    tile_.sections.resize(cutter.tile_levels() - 1);
    done_.resize(tile_.sections.size());
    numbers_.resize(tile_.sections.size());
    tile_.layer_root = visit(cube).layers;
    if (cutter.layers_.empty()) tile_.layer_root = kNoLayerSet;
    tile_.layer_sets.resize(sets_.size());
    for (const auto& [members, number] : sets_) tile_.layer_sets[number] = members;
  }
  DagTile take() { return std::move(tile_); }

 private:
  struct Result {
    uint32_t shape;   // offset in the section
    uint32_t layers;  // value
  };
  using Octants = std::array<uint32_t, 8>;

  static std::string bytes_of(std::span<const uint32_t> words) {
    return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(uint32_t)};
  }
  static std::string key_of(const TileCube& cube) {
    std::string key;
    for (const LayerNode& node : cube.nodes) key += bytes_of({{node.layer, node.node}});
    return key;
  }

  Result visit(const TileCube& cube) {
    auto& done = done_[cube.level - top_];
    const std::string key = key_of(cube);
    if (const auto found = done.find(key); found != done.end()) return found->second;
    const Result result = cube.level == bricks_ ? brick(cube) : node(cube);
    done.emplace(key, result);
    return result;
  }

  Result node(const TileCube& cube) {
    std::vector<uint32_t> words = {0};
    Octants layers;
    for (unsigned c = 0; c < 8; ++c) {
      layers[c] = kNoLayerSet;
      const TileCube octant = cutter_.octant(cube, c);
      if (octant.nodes.empty()) continue;
      const Result child = visit(octant);
      words[0] |= 1U << c;
      words.push_back(child.shape);
      layers[c] = child.layers;
    }
    return {add(cube.level - top_, words), layer_value(layers)};
  }

  Result brick(const TileCube& cube) {
    std::vector<Brick> of_node;
    Brick all = 0;
    for (const LayerNode& node : cube.nodes) {
      of_node.push_back(brick_of_two_levels(cutter_.view(cube, node), cube.level, node.node));
      all |= of_node.back();
    }
    const uint32_t shape = add(cube.level - top_, {uint32_t(all), uint32_t(all >> 32)});
    if (cutter_.layers_.empty()) return {shape, kNoLayerSet};
    Octants blocks;
    for (unsigned b = 0; b < 8; ++b) {
      Octants cells;
      for (unsigned c = 0; c < 8; ++c)
        cells[c] = all >> (8 * b + c) & 1 ? set_of(cube, of_node, 8 * b + c) : kNoLayerSet;
      blocks[b] = layer_value(cells);
    }
    return {shape, layer_value(blocks)};
  }

  // Adds a node or brick unless the section has it; returns its offset.
  uint32_t add(size_t depth, const std::vector<uint32_t>& words) {
    std::vector<uint32_t>& section = tile_.sections[depth];
    const auto [at, is_new] = numbers_[depth].emplace(bytes_of(words), uint32_t(section.size()));
    if (is_new) section.insert(section.end(), words.begin(), words.end());
    return at->second;
  }

  // The value of the set of the layers that hold cell `bit`.
  uint32_t set_of(const TileCube& cube, const std::vector<Brick>& of_node, unsigned bit) {
    std::vector<uint32_t> members;
    for (size_t i = 0; i < of_node.size(); ++i) {
      if (of_node[i] >> bit & 1 && cube.nodes[i].layer != TileCube::kUnion)
        members.push_back(cube.nodes[i].layer);
    }
    return kLayerSet + sets_.emplace(members, uint32_t(sets_.size())).first->second;
  }

  uint32_t layer_value(const Octants& octants) {
    uint32_t one = kNoLayerSet;
    bool same = true;
    for (const uint32_t value : octants) {
      if (value == kNoLayerSet) continue;
      same = same && (value & kLayerSet) != 0 && (one == kNoLayerSet || one == value);
      one = value;
    }
    if (same) return one;
    const auto [at, is_new] =
        layer_numbers_.emplace(bytes_of(octants), uint32_t(tile_.layer_nodes.size()));
    if (is_new) tile_.layer_nodes.insert(tile_.layer_nodes.end(), octants.begin(), octants.end());
    return at->second;
  }

  const TileCutter& cutter_;
  uint32_t bricks_, top_;  // levels
  DagTile tile_;
  std::vector<std::unordered_map<std::string, Result>> done_;       // [depth], by nodes
  std::vector<std::unordered_map<std::string, uint32_t>> numbers_;  // [depth], by words
  std::unordered_map<std::string, uint32_t> layer_numbers_;         // by words
  std::map<std::vector<uint32_t>, uint32_t> sets_;                  // by members
};

DagTile TileCutter::cut(const TileCube& cube) const {
  return Cut(*this, cube).take();
}

std::optional<DagTile> tile_of_path(const TileCutter& cutter, uint64_t path) {
  if (path == 0) return {};
  const uint32_t bits = uint32_t(std::bit_width(path)) - 1;
  if (bits % 3 != 0) return {};
  TileCube cube = cutter.root();
  for (uint32_t at = bits; at > 0 && !cube.nodes.empty(); at -= 3) {
    if (!cutter.has_finer(cube)) return {};
    cube = cutter.octant(cube, unsigned(path >> (at - 3) & 7));
    if (cutter.is_full(cube)) return {};
  }
  if (cube.nodes.empty()) return {};
  DagTile tile = cutter.cut(cube);
  for (unsigned c = 0; c < 8 && cutter.has_finer(cube); ++c) {
    const TileCube octant = cutter.octant(cube, c);
    if (!octant.nodes.empty() && !cutter.is_full(octant)) tile.finer[c] = path << 3 | c;
  }
  return tile;
}

}  // namespace svdag
