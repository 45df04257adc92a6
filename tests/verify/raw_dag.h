// A DAG file by hand: written from docs/format.md alone, without the project's writer, so that a
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

// What a file says, level by level, open to vandalism.
struct RawDag {
  Grid grid;
  std::vector<std::vector<uint32_t>> words;  // levels 0 .. L-3
  std::vector<uint64_t> bricks;
  std::vector<uint64_t> nodes;  // levels 0 .. L-2
  uint64_t voxels = 0;
  double largest_snap = 0;
  Rule rule = Rule::kConservative;
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
  return "{\"format\":\"svdag\",\"version\":1,\"levels\":" + std::to_string(g.levels) +
         ",\"resolution\":" + std::to_string(g.resolution()) + ",\"rule\":\"" +
         rule_name(raw.rule) + "\",\"fraction_bits\":" + std::to_string(g.fraction()) +
         ",\"grid\":{\"kind\":\"" + kind_name(g.kind) +
         "\",\"corner\":" + list(corner) + ",\"voxel_size\":" + number(g.voxel_size) +
         ",\"k0\":" + list(k0) + ",\"bounded\":" + (g.bounded ? "true" : "false") +
         ",\"selection\":" + list(selection) + "},\"voxels\":" + std::to_string(raw.voxels) +
         ",\"nodes\":" + list(raw.nodes) + ",\"largest_snap\":" + number(raw.largest_snap) + "}\n";
}

// A file in memory, 8-byte aligned.
class RawFile {
 public:
  explicit RawFile(const RawDag& raw) : metadata_(raw_metadata(raw)) {
    Header h{};
    std::memcpy(h.magic, kMagic, sizeof kMagic);
    h.version = 1;
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
