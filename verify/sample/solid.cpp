#include "verify/sample/solid.h"

#include <algorithm>
#include <atomic>
#include <tuple>

#include "verify/judge/judge_cells.h"

namespace svdag {
namespace {

bool selects(const Grid& grid, const LatticePoint& voxel) {
  return grid.selection.holds({voxel, voxel + int64_t(1)});
}

}  // namespace

SolidColumns::SolidColumns(const Grid& grid, Rule rule, std::span<const LatticeTriangle> triangles,
                           Judge& judge)
    : grid_(grid), rule_(rule) {
  if (!is_solid(rule)) return;
  for (const LatticeTriangle& triangle : triangles) {
    judge.windings(triangle, grid.fraction(), grid.whole(),
                   [&](const LatticePoint& voxel, int change) {
                     changes_.push_back(
                         {uint64_t(voxel.x) << 20 | uint64_t(voxel.y), int32_t(voxel.z), change});
                   });
  }
  std::ranges::sort(changes_, {}, [](const Change& c) { return std::tuple(c.column, c.z); });
}

std::span<const SolidColumns::Change> SolidColumns::column(int64_t x, int64_t y) const {
  const uint64_t key = uint64_t(x) << 20 | uint64_t(y);
  return {std::ranges::lower_bound(changes_, key, {}, &Change::column),
          std::ranges::upper_bound(changes_, key, {}, &Change::column)};
}

template <class Visit>
void SolidColumns::for_each_inside(std::span<const Change> column, const Visit& visit) const {
  int32_t winding = 0;
  for (size_t i = 0; i < column.size(); ++i) {
    winding += column[i].change;
    const int64_t end = i + 1 < column.size() ? column[i + 1].z : grid_.resolution();
    const int64_t low = std::max<int64_t>(column[i].z, grid_.selection.min.z);
    const int64_t high = std::min(end, grid_.selection.max.z);
    if (low < high && is_inside(rule_, winding)) visit(low, high);
  }
}

void SolidColumns::fill(const LatticePoint& corner, int64_t side, JudgedCube* cube) const {
  if (changes_.empty()) return;
  for (int64_t x = 0; x < side; ++x) {
    for (int64_t y = 0; y < side; ++y) {
      const LatticePoint at = corner + LatticePoint(x, y, 0);
      if (at.x < grid_.selection.min.x || at.x >= grid_.selection.max.x ||
          at.y < grid_.selection.min.y || at.y >= grid_.selection.max.y)
        continue;
      for_each_inside(column(at.x, at.y), [&](int64_t low, int64_t high) {
        low = std::max(low, corner.z);
        high = std::min(high, corner.z + side);
        if (low < high) cube->set({LatticePoint(x, y, low - corner.z), 2, high - low});
      });
    }
  }
}

std::vector<uint64_t> SolidColumns::cubes() const {
  const int log2 = judged_cube_levels(grid_.levels);
  std::vector<bool> is_inside(size_t(1) << 3 * (grid_.levels - log2));
  for (size_t begin = 0, end = 0; begin < changes_.size(); begin = end) {
    const uint64_t column = changes_[begin].column;
    while (end < changes_.size() && changes_[end].column == column) ++end;
    LatticePoint cube(int64_t(column >> 20), int64_t(column & 0xFFFFF), 0);
    if (!selects(grid_, {cube.x, cube.y, grid_.selection.min.z})) continue;
    cube.x >>= log2, cube.y >>= log2;
    for_each_inside(std::span(changes_).subspan(begin, end - begin),
                    [&](int64_t low, int64_t high) {
                      for (cube.z = low >> log2; cube.z <= (high - 1) >> log2; ++cube.z)
                        is_inside[cell_code(cube)] = true;
                    });
  }
  std::vector<uint64_t> codes;
  for (size_t code = 0; code < is_inside.size(); ++code) {
    if (is_inside[code]) codes.push_back(code);
  }
  return codes;
}

SolidBricks::SolidBricks(const Grid& grid, const std::vector<uint64_t>& codes)
    : grid_(grid), windings_(64 * codes.size()) {
  for (const uint64_t code : codes) {
    LatticePoint brick = cell_of_code(code);
    corners_.push_back(brick * int64_t(kBrickSide));
    brick.z = 0;
    places_.push_back({cell_code(brick), uint32_t(places_.size())});
  }
  std::ranges::sort(places_, {}, &Place::column);
}

void SolidBricks::add(const LatticeTriangle& triangle, Judge& judge) {
  const VoxelBox bricks{LatticePoint(0), LatticePoint(grid_.resolution() / kBrickSide)};
  LatticeBox box = box_of(triangle);
  box.min.z = box.max.z = 0;  // bricks above the triangle count it, too
  const VoxelBox touched = touched_cells(box, grid_.fraction() + 2, bricks);
  if (!touched.empty()) descend(triangle, judge, touched, 0, grid_.levels - 2, places_);
}

// `places` are the bricks in the columns of `cell`, a square of 2^height bricks a side.
void SolidBricks::descend(const LatticeTriangle& triangle, Judge& judge, const VoxelBox& box,
                          uint64_t cell, int height, std::span<const Place> places) {
  if (places.empty()) return;
  const LatticePoint first = cell_of_code(cell) << int64_t(height);
  const int64_t side = int64_t(1) << height;
  for (int a = 0; a < 2; ++a) {
    if (first[a] >= box.max[a] || first[a] + side <= box.min[a]) return;
  }
  if (height == 0) {
    for (const Place& place : places) count(triangle, judge, place.index);
    return;
  }
  for (uint64_t child = cell << 3; child < (cell + 1) << 3; child += 2) {  // z is 0
    const uint64_t beyond = (child + 2) << 3 * (height - 1);
    const auto end = std::ranges::lower_bound(places, beyond, {}, &Place::column);
    const auto middle = size_t(end - places.begin());
    descend(triangle, judge, box, child, height - 1, places.first(middle));
    places = places.subspan(middle);
  }
}

void SolidBricks::count(const LatticeTriangle& triangle, Judge& judge, size_t index) {
  const LatticePoint corner = corners_[index];
  judge.windings(
      triangle, grid_.fraction(), {corner, corner + int64_t(kBrickSide)},
      [&](LatticePoint voxel, int change) {
        for (; voxel.z < corner.z + kBrickSide; ++voxel.z) {
          const LatticePoint p = voxel - corner;
          const unsigned bit = brick_bit(unsigned(p.x), unsigned(p.y), unsigned(p.z));
          std::atomic_ref(windings_[64 * index + bit]).fetch_add(change, std::memory_order_relaxed);
        }
      });
}

Brick SolidBricks::inside(Rule rule, size_t index) const {
  Brick brick = 0;
  for (unsigned bit = 0; bit < 64; ++bit) {
    const auto [x, y, z] = brick_voxel(bit);
    if (is_inside(rule, windings_[64 * index + bit]) &&
        selects(grid_, corners_[index] + LatticePoint(x, y, z)))
      brick |= Brick(1) << bit;
  }
  return brick;
}

}  // namespace svdag
