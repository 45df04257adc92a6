// The layers of a `.svdag` file (docs/format.md, "Layers"): named sets of voxels of the same grid,
// each with a root of its own in level 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/colour.h"
#include "io/dag/format.h"

namespace svdag {

constexpr uint32_t kNoRoot = 0xffffffffU;

struct Layer {
  std::string name;  // bytes as in the source; empty: what has no name there
  Colour colour;
  uint64_t voxels = 0;
  uint32_t root = kNoRoot;  // number in level 0; kNoRoot if no voxel is set
};

// A layer's name for people: "(unnamed)" for the empty name.
std::string shown_layer(const std::string& name);

struct LayerTable {
  LayerKind kind = LayerKind::kNone;  // kNone: the file has no layers
  bool has_union = true;              // level 0 begins with the root of the union
  uint32_t union_root = 0;            // number in level 0, if there is one; 0 in a file
  std::vector<Layer> layers;          // by name, ascending and unique

  bool empty() const { return kind == LayerKind::kNone; }
  // The root that a program shows by default: the root of the union, or without a union of the
  // first layer that has one; kNoRoot if nothing is set.
  uint32_t default_root() const;
  // Its voxels, if the union has `of_union`.
  uint64_t default_voxels(uint64_t of_union) const;
};

// The numbers of the layers with this name, else of those that the pattern matches; maybe none.
std::set<size_t> layers_matching(const LayerTable& table, const std::string& pattern);

// The numbers of the layers that --layer chooses, ascending, each once. A name is that layer; any
// other text is a shell pattern (*, ?, [..]), and "!PATTERN" excludes what it matches, of all
// layers if nothing is chosen. "(unnamed)" is the empty name, unless a layer has that very name.
// Error (kUsage), with the nearest name, if no layer matches, or none is left.
std::vector<size_t> layers_named(const LayerTable& table, const std::vector<std::string>& names);

std::vector<std::byte> encode_layers(const LayerTable& table);

// The entries of a table of `count` layers, in `bytes`; nothing if they are invalid: a name twice
// or out of order, a layer without voxels that has a root.
std::optional<std::vector<Layer>> decode_entries(uint32_t count, std::span<const std::byte> bytes);

// The table that `header` describes and `bytes` hold; nothing if it is invalid: too many roots,
// invalid entries, a root that does not exist or that no layer has, a layer without a root that has
// voxels.
std::optional<LayerTable> decode_layers(const Header& header, std::span<const std::byte> bytes);

// The grey of what has no layer, or no name and no colour.
constexpr Colour kNeutralColour{0xbc, 0xb5, 0xaa};

// The colour of a layer whose source has none: one of 48 hues in 3 tones, chosen by the name; grey
// without a name.
Colour palette_colour(std::string_view name);

}  // namespace svdag
