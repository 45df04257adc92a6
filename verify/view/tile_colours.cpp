#include "verify/view/tile_colours.h"

#include <algorithm>
#include <bit>

namespace svdag {
namespace {

// Visits cubes with the numbers of their first colours.
class ColourWalk {
 public:
  ColourWalk(const DagColours& colours, uint32_t level, uint32_t max_colours)
      : view_(colours.view()), tables_(colours.tables()), level_(level), max_(max_colours) {}

  // Moves from the grid down to the cube of `path`; false if it has no voxel.
  bool descend(uint64_t path, uint32_t levels) {
    while (cube_.level < levels) {
      const uint64_t octant = path >> 3 * (levels - 1 - cube_.level) & 7;
      std::optional<CoveredCube> next;
      number_ += view_.counts.own(cube_.level);
      for_covered_children(view_.dag, cube_, [&](const CoveredCube& child) {
        if ((child.morton & 7) < octant) number_ += tables_.of(child);
        if ((child.morton & 7) == octant) next = child;
      });
      if (!next) return false;
      cube_ = *next;
    }
    return true;
  }
  // The colours below; nothing if there are too many.
  std::optional<std::vector<uint32_t>> collect() {
    visit(cube_, number_);
    if (found_.size() > max_) return std::nullopt;
    return std::move(found_);
  }

 private:
  void visit(const CoveredCube& cube, uint64_t number) {
    if (found_.size() > max_) return;
    if (cube.level == level_) {
      found_.push_back(colour_at(view_, number));
      return;
    }
    number += view_.counts.own(cube.level);
    for_covered_children(view_.dag, cube, [&](const CoveredCube& child) {
      visit(child, number);
      number += tables_.of(child);
    });
  }

  const ColourView& view_;
  const ColourCountTables& tables_;
  const uint32_t level_, max_;
  CoveredCube cube_;
  uint64_t number_ = 0;
  std::vector<uint32_t> found_;
};

}  // namespace

std::optional<std::vector<uint32_t>> colours_of_tile(const DagColours& colours, uint64_t path,
                                                     uint32_t level, uint32_t max_colours) {
  const ColourView& view = colours.view();
  if (path == 0 || view.dag.empty() || level > view.level() || view.counts.own(level) == 0)
    return {};
  const uint32_t bits = uint32_t(std::bit_width(path)) - 1;
  if (bits % 3 != 0 || bits / 3 > level) return {};
  ColourWalk walk(colours, level, max_colours);
  if (!walk.descend(path, bits / 3)) return {};
  return walk.collect();
}

std::optional<TileColours> colours_in_page(const DagColours& colours, uint64_t path,
                                           uint32_t tile_levels, uint32_t coarser,
                                           uint32_t max_colours) {
  const uint32_t finest = colours.view().level();
  const uint32_t tile_level = (uint32_t(std::bit_width(path)) - 1) / 3;
  uint32_t level = std::min(finest, tile_level + tile_levels);
  level -= (finest - level) % 2;
  const uint32_t coarsest = std::max({1U, tile_level, coarser + 1});
  for (; level >= coarsest && level <= finest; level -= 2) {  // or below 0
    if (auto found = colours_of_tile(colours, path, level, max_colours))
      return TileColours{level, *found};
  }
  return std::nullopt;
}

}  // namespace svdag
