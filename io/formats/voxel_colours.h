// The colour of each exported voxel: the stored one of a file with colours, else its layer's.
#pragma once

#include <bit>
#include <optional>

#include "io/dag/colours/dag_colours.h"
#include "io/formats/layer_labels.h"

namespace svdag {

class VoxelColours {
 public:
  static bool has_some(const DagFile& file) { return file.has_colours() || !file.layers().empty(); }

  // `file` has some, and must outlive this. `level`: of the exported voxels. Error (kMemory), and
  // Error (kBadInput) if the file's colours are damaged.
  VoxelColours(const DagFile& file, int level, MemoryBudget* budget) : level_(uint32_t(level)) {
    if (file.has_colours())
      stored_.emplace(file, budget);
    else
      labels_.emplace(file, level);
  }

  bool are_stored() const { return stored_.has_value(); }
  // Of what no triangle touches, inside of a solid: kNeutralColour.
  Colour of(const Voxel& voxel) const {
    if (!stored_) return labels_->colour_of(voxel);
    return colour_of(svdag_colour(stored_->view(), level_, voxel[0], voxel[1], voxel[2]));
  }
  // The stored colour of all voxels of a full cube; nothing if they may differ: if the cube is
  // larger than one of level K, and no part of a uniform one (docs/format.md, "Colours").
  std::optional<Colour> of_full_cube(const VoxelCube& cube) const {
    const ColourView& view = stored_->view();
    const uint32_t cube_level = level_ - uint32_t(std::countr_zero(uint64_t(cube.side)));
    const Voxel first{uint32_t(cube.origin.x), uint32_t(cube.origin.y), uint32_t(cube.origin.z)};
    const uint32_t finest = view.level();  // that voxels show
    const uint32_t shown = level_ >= finest ? finest : level_ - (finest - level_) % 2;
    if (cube_level >= shown) return of(first);
    CoveredCube at;
    uint64_t number = 0;
    while (at.level < cube_level) {
      const uint32_t c = octant_of(first[0], first[1], first[2], level_ - 1 - at.level);
      CoveredCube next;
      number += view.counts.own(at.level);
      for_covered_children(view.dag, at, [&](const CoveredCube& child) {
        if ((child.morton & 7) < c) number += stored_->tables().of(child);
        if ((child.morton & 7) == c) next = child;
      });
      at = next;
    }
    const auto uniform = uniform_at(view, number, stored_->tables().of(at));
    return uniform ? std::optional(colour_of(*uniform)) : std::nullopt;
  }

 private:
  static Colour colour_of(uint32_t code) {
    if (code == kNoColour) return kNeutralColour;
    return {uint8_t(code), uint8_t(code >> 8), uint8_t(code >> 16)};
  }
  // The value of the colours from `number` on, if one entry of the directory holds all of them.
  static std::optional<uint32_t> uniform_at(const ColourView& view, uint64_t number,
                                            uint64_t count) {
    const ColourEntry* const end = view.entries + view.entry_count;
    const ColourEntry* const next =
        std::upper_bound(view.entries, end, number,
                         [](uint64_t n, const ColourEntry& entry) { return n < entry.first; });
    const bool is_whole = next == end || next->first - number >= count;
    if (!is_whole || (next[-1].value & kChunkEntry) != 0) return std::nullopt;
    return uint32_t(next[-1].value);
  }

  std::optional<DagColours> stored_;
  std::optional<LayerLabels> labels_;  // without stored colours
  uint32_t level_;
};

}  // namespace svdag
