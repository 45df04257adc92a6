// The grid fields at the beginning of the headers of `.svdag` and `.run` files. Both headers have
// them at the same offsets and under the same names, except the corner (docs/format.md,
// docs/run-format.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>

#include "io/dag/format.h"
#include "io/grid.h"

namespace svdag {

// The rule of this name; nothing if there is none.
constexpr std::optional<Rule> rule_named(std::string_view name) {
  for (size_t i = 0; i < std::size(kRuleNames); ++i) {
    if (name == kRuleNames[i]) return Rule(i);
  }
  return {};
}

// Stores zeros for the identity: files of a scene that was not transformed.
template <class H>
void put_transform(const Affine& transform, H* header) {
  for (size_t i = 0; i < 12; ++i)
    header->transform[i] = transform == Affine() ? 0 : transform.m[i / 4][i % 4];
}

template <class H>
void put_grid(const Grid& grid, Rule rule, H* header) {
  header->levels = uint32_t(grid.levels);
  header->fraction = uint32_t(grid.fraction());
  header->rule = uint32_t(rule);
  header->grid_kind = uint32_t(grid.kind);
  header->voxel_size = grid.voxel_size;
  header->bounded = grid.bounded;
  for (int a = 0; a < 3; ++a) {
    header->k0[a] = grid.k0[a];
    header->selection_min[a] = uint32_t(grid.selection.min[a]);
    header->selection_max[a] = uint32_t(grid.selection.max[a]);
  }
  put_transform(grid.transform, header);
}

// Whether the scene was transformed: files without a transform store zeros.
template <class H>
bool has_transform(const H& header) {
  return std::any_of(std::begin(header.transform), std::end(header.transform),
                     [](double v) { return v != 0; });
}

// `origin`: the field of the header that holds Grid::origin.
template <class H>
Grid get_grid(const H& header, const double (&origin)[3]) {
  Grid grid;
  grid.kind = Grid::Kind(header.grid_kind);
  grid.levels = int(header.levels);
  grid.voxel_size = header.voxel_size;
  grid.bounded = header.bounded != 0;
  for (int a = 0; a < 3; ++a) {
    if (grid.kind != Grid::Kind::kLattice) grid.origin[a] = origin[a];
    grid.k0[a] = header.k0[a];
    grid.selection.min[a] = header.selection_min[a];
    grid.selection.max[a] = header.selection_max[a];
  }
  if (has_transform(header)) {
    for (size_t i = 0; i < 12; ++i) grid.transform.m[i / 4][i % 4] = header.transform[i];
  }
  return grid;
}

// Checks the fields, each with a call of require(condition, message, offset).
template <class H, class Require>
void check_grid(const H& h, const Require& require) {
  require(h.levels >= uint32_t(kMinLevels) && h.levels <= uint32_t(kMaxLevels),
          "the number of levels is not 3 to 20", offsetof(H, levels));
  require(h.fraction == uint32_t(fraction_bits(int(h.levels))), "wrong lattice fraction",
          offsetof(H, fraction));
  require(h.rule < std::size(kRuleNames), "unknown rule", offsetof(H, rule));
  require(h.grid_kind < std::size(kGridKindNames), "unknown kind of grid", offsetof(H, grid_kind));
  require(std::isnormal(h.voxel_size) && h.voxel_size > 0, "impossible voxel size",
          offsetof(H, voxel_size));
  require(h.bounded <= 1, "impossible flag", offsetof(H, bounded));
  const Affine transform = get_grid(h, {0, 0, 0}).transform;
  H written = h;
  put_transform(transform, &written);  // neither -0 nor ones on the diagonal for the identity
  require(is_invertible(transform) &&
              std::memcmp(written.transform, h.transform, sizeof h.transform) == 0,
          "impossible transform", offsetof(H, transform));
  const uint32_t n = 1U << h.levels;
  for (int a = 0; a < 3; ++a) {
    require(h.selection_min[a] <= h.selection_max[a] && h.selection_max[a] <= n,
            "impossible selection", offsetof(H, selection_min));
    require(h.bounded || (h.selection_min[a] == 0 && h.selection_max[a] == n),
            "impossible selection", offsetof(H, selection_min));
    require(h.k0[a] >= -kFarthestPlane && h.k0[a] <= kFarthestPlane,
            "the corner of the grid is more than 2^38 voxels from zero", offsetof(H, k0));
  }
}

}  // namespace svdag
