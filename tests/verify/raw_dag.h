// A DAG file by hand: written only from docs/format.md, without the project's writer, so that a
// test can also make files that no writer would make.
#pragma once

#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/dag/dag_view.h"
#include "io/grid.h"
#include "io/units.h"
#include "streaming/file/checksum.h"
#include "tests/verify/rational_judge.h"

namespace svdag {

struct RawLayer {
  std::string name;
  uint64_t voxels;
  uint32_t root;  // 0xffffffff without voxels
};

// What a file says, level by level, open to vandalism.
struct RawDag {
  Grid grid;
  std::vector<std::vector<uint32_t>> words;  // levels 0 .. L-3
  std::vector<uint64_t> bricks;
  std::vector<uint64_t> nodes;  // levels 0 .. L-2
  uint64_t voxels = 0;
  double largest_snap = 0;
  Rule rule = Rule::kConservative;
  std::vector<RawLayer> layers = {};  // materials, with their union
};

// The minimal DAG of `voxels` in canonical order, by sets and maps.
inline RawDag raw_dag(const Grid& grid, const VoxelSet& voxels) {
  using Cell = std::array<int64_t, 3>;
  using Children = std::array<uint32_t, 8>;
  RawDag raw{grid, {}, {}, std::vector<uint64_t>(size_t(grid.levels - 1)), voxels.size(), 0, {}};
  raw.words.resize(size_t(grid.levels - 2));
  std::map<Cell, uint64_t> masks;
  for (const auto& [x, y, z] : voxels) {
    const auto bit = 8 * (4 * (x >> 1 & 1) + 2 * (y >> 1 & 1) + (z >> 1 & 1)) +
                     (4 * (x & 1) + 2 * (y & 1) + (z & 1));
    masks[{x >> 2, y >> 2, z >> 2}] |= uint64_t(1) << bit;
  }
  std::set<uint64_t> unique;
  for (const auto& [cell, mask] : masks) unique.insert(mask);
  raw.bricks.assign(unique.begin(), unique.end());
  raw.nodes.back() = raw.bricks.size();
  std::map<Cell, uint32_t> below;  // 1 + index
  for (const auto& [cell, mask] : masks)
    below[cell] = 1 + uint32_t(std::distance(unique.begin(), unique.find(mask)));
  for (int level = grid.levels - 3; level >= 0; --level) {
    std::map<Cell, Children> cells;
    for (const auto& [c, id] : below)
      cells[{c[0] >> 1, c[1] >> 1, c[2] >> 1}]
           [size_t(4 * (c[0] & 1) + 2 * (c[1] & 1) + (c[2] & 1))] = id;
    std::map<Children, uint32_t> numbers;
    for (const auto& [cell, children] : cells) numbers[children] = 0;
    std::vector<uint32_t>& words = raw.words[size_t(level)];
    for (auto& [children, number] : numbers) {
      number = 1 + uint32_t(words.size());
      words.push_back(0);
      for (unsigned c = 0; c < 8; ++c) {
        if (children[c] == 0) continue;
        words[number - 1] |= 1U << c;
        words.push_back(children[c] - 1);
      }
    }
    raw.nodes[size_t(level)] = numbers.size();
    below.clear();
    for (const auto& [cell, children] : cells) below[cell] = numbers[children];
  }
  return raw;
}

// The DAG of a file with the layers "a", "b", ... of `sets`, at most seven of them, not all empty.
// The sets, and their union first, are octants of a grid twice as fine, whose level 1 becomes level
// 0.
// `as_union`: instead of it.
inline RawDag raw_layers(const Grid& grid, const std::vector<VoxelSet>& sets,
                         const VoxelSet& as_union = {}) {
  std::vector<VoxelSet> all{as_union};
  for (const VoxelSet& set : sets) {
    if (as_union.empty()) all[0].insert(set.begin(), set.end());
  }
  all.insert(all.end(), sets.begin(), sets.end());
  const int64_t side = grid.resolution();
  VoxelSet octants;
  for (size_t i = 0; i < all.size(); ++i) {
    for (const auto& [x, y, z] : all[i])
      octants.emplace(x + side * int64_t(i >> 2), y + side * int64_t(i >> 1 & 1),
                      z + side * int64_t(i & 1));
  }
  Grid finer = grid;
  ++finer.levels;
  RawDag raw = raw_dag(finer, octants);
  std::map<uint32_t, uint32_t> number;  // of the word where a root begins
  std::vector<std::vector<uint32_t>> roots;
  const std::vector<uint32_t> top = raw.words[0], words = raw.words[1];
  const uint32_t first = top[1];  // the union is in octant 0
  const auto node_at = [&](uint32_t at) {
    return std::vector<uint32_t>(words.begin() + at,
                                 words.begin() + at + 1 + __builtin_popcount(words[at]));
  };
  number[first] = 0;
  roots.push_back(node_at(first));
  for (uint32_t at = 0; at < words.size(); at += uint32_t(node_at(at).size())) {
    if (!number.emplace(at, uint32_t(roots.size())).second) continue;
    roots.push_back(node_at(at));
  }
  raw.grid = grid;
  raw.voxels = all[0].size();
  raw.words.erase(raw.words.begin());
  raw.nodes.erase(raw.nodes.begin());
  raw.words[0].clear();
  for (const auto& root : roots) raw.words[0].insert(raw.words[0].end(), root.begin(), root.end());
  size_t child = 1;
  for (size_t i = 1; i < all.size(); ++i) {
    const bool empty = all[i].empty();
    if (!empty) ++child;
    raw.layers.push_back({std::string(1, char('a' + i - 1)), all[i].size(),
                          empty ? 0xffffffffU : number[top[child]]});
  }
  return raw;
}

inline Grid test_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.voxel_size = 0.5;
  grid.origin = Point(-1, 2, 3);
  grid.selection = grid.whole();
  return grid;
}

inline std::string raw_metadata(const RawDag& raw) {
  const Grid& g = raw.grid;
  const auto number = [](auto n) {
    if constexpr (std::is_same_v<decltype(n), double>)
      return format_double(n);
    else
      return std::to_string(n);
  };
  const auto list = [&](const auto& items) {
    std::string text;
    for (const auto& item : items) text += (text.empty() ? "[" : ",") + number(item);
    return text + "]";
  };
  const std::array<double, 3> corner{g.corner().x, g.corner().y, g.corner().z};
  const std::array<int64_t, 3> k0{g.k0.x, g.k0.y, g.k0.z};
  const std::array<int64_t, 6> selection{g.selection.min.x, g.selection.min.y, g.selection.min.z,
                                         g.selection.max.x, g.selection.max.y, g.selection.max.z};
  return std::string("{\"format\":\"svdag\",\"version\":") + (raw.layers.empty() ? "1" : "2") +
         ",\"levels\":" + std::to_string(g.levels) +
         ",\"resolution\":" + std::to_string(g.resolution()) + ",\"rule\":\"" +
         rule_name(raw.rule) + "\",\"fraction_bits\":" + std::to_string(g.fraction()) +
         ",\"grid\":{\"kind\":\"" + kind_name(g.kind) + "\",\"corner\":" + list(corner) +
         ",\"voxel_size\":" + number(g.voxel_size) + ",\"k0\":" + list(k0) +
         ",\"bounded\":" + (g.bounded ? "true" : "false") + ",\"selection\":" + list(selection) +
         "},\"voxels\":" + std::to_string(raw.voxels) + ",\"nodes\":" + list(raw.nodes) +
         ",\"largest_snap\":" + number(raw.largest_snap) +
         (raw.layers.empty() ? ""
                             : ",\"layers\":{\"kind\":\"material\",\"count\":" +
                                   std::to_string(raw.layers.size()) + ",\"union\":true}") +
         "}\n";
}

// A file in memory, 8-byte aligned.
class RawFile {
 public:
  explicit RawFile(const RawDag& raw) : metadata_(raw_metadata(raw)) {
    Header h{};
    std::memcpy(h.magic, kMagic, sizeof kMagic);
    h.version = raw.layers.empty() ? 1 : 2;
    h.header_bytes = 1024;
    h.levels = uint32_t(raw.grid.levels);
    h.fraction = uint32_t(raw.grid.fraction());
    h.rule = uint32_t(raw.rule);
    h.grid_kind = uint32_t(raw.grid.kind);
    h.voxel_size = raw.grid.voxel_size;
    h.bounded = raw.grid.bounded;
    h.section_count = h.levels - 1;
    for (int a = 0; a < 3; ++a) {
      h.corner[a] = raw.grid.corner()[a];
      h.k0[a] = raw.grid.k0[a];
      h.selection_min[a] = uint32_t(raw.grid.selection.min[a]);
      h.selection_max[a] = uint32_t(raw.grid.selection.max[a]);
    }
    h.voxels = raw.voxels;
    h.largest_snap = raw.largest_snap;
    bytes_.resize(1024);
    for (size_t level = raw.nodes.size(); level-- > 0;) {
      const bool bricks = level + 1 == raw.nodes.size();
      const auto part = bricks ? std::as_bytes(std::span(raw.bricks))
                               : std::as_bytes(std::span(raw.words[level]));
      h.sections[level] = {place(part), part.size(), raw.nodes[level]};
    }
    if (!raw.layers.empty()) {
      const std::vector<std::byte> table = raw_layer_table(raw.layers);
      h.layers_offset = place(table);
      h.layers_bytes = table.size();
      h.layer_count = uint32_t(raw.layers.size());
      h.layer_kind = 2;
      h.has_union = 1;
    }
    h.metadata_offset = place(std::as_bytes(std::span(metadata_)));
    h.metadata_bytes = metadata_.size();
    finish(h);
  }

  const Header& header() const { return *reinterpret_cast<const Header*>(bytes_.data()); }
  DagView view() const { return dag_view(bytes_.data()); }
  const std::string& metadata() const { return metadata_; }
  const std::vector<std::byte>& bytes() const { return bytes_; }
  void write(const std::string& path) const {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes_.data()), std::streamsize(bytes_.size()));
  }

 private:
  static std::vector<std::byte> raw_layer_table(const std::vector<RawLayer>& layers) {
    std::vector<std::byte> bytes;
    const auto put = [&](uint64_t value, int size) {
      for (int i = 0; i < size; ++i) bytes.push_back(std::byte(value >> 8 * i));
    };
    for (const RawLayer& layer : layers) {
      put(layer.voxels, 8);
      put(layer.root, 4);
      put(layer.name.size(), 4);
      put(0, 8);  // black
    }
    for (const RawLayer& layer : layers) {
      for (const char c : layer.name) put(uint8_t(c), 1);
    }
    return bytes;
  }
  uint64_t place(std::span<const std::byte> part) {
    bytes_.resize((bytes_.size() + 63) / 64 * 64);
    const uint64_t offset = bytes_.size();
    bytes_.insert(bytes_.end(), part.begin(), part.end());
    return offset;
  }
  void finish(Header h) {
    bytes_.resize((bytes_.size() + 63) / 64 * 64);
    std::vector<uint64_t> table;
    for (size_t at = 1024; at < bytes_.size(); at += 65536)
      table.push_back(
          checksum64(std::span(bytes_).subspan(at, std::min<size_t>(65536, bytes_.size() - at))));
    h.checksum_offset = place(std::as_bytes(std::span(table)));
    h.checksum_bytes = 8 * table.size();
    h.file_bytes = bytes_.size();
    Hasher128 hasher;
    hasher.update(std::as_bytes(std::span(&h, 1)));
    hasher.update(std::as_bytes(std::span(table)));
    const Hash128 hash = hasher.digest();
    h.content_hash[0] = hash[0];
    h.content_hash[1] = hash[1];
    h.header_checksum = checksum64(std::as_bytes(std::span(&h, 1)).first(1016));
    std::memcpy(bytes_.data(), &h, sizeof h);
  }

  std::string metadata_;
  std::vector<std::byte> bytes_;
};

}  // namespace svdag
