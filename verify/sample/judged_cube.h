// The judge's unit of comparison: a cube of 64^3 voxels (or the whole of a smaller grid).
//
// Its 16^3 bricks are in Morton order in 32 KiB, which fits the first-level cache; a DAG fills
// them in one descent. Larger cubes would save set-up, but every clear and compare would miss that
// cache.
#pragma once

#include <algorithm>
#include <array>

#include "io/brick.h"
#include "io/dag/dag_view.h"
#include "io/grid.h"
#include "verify/judge/clip_judge.h"
#include "verify/judge/judge_cells.h"

namespace svdag {

constexpr int kJudgedCubeLevels = 6;

// log2 of the side of a cube of this grid.
inline int judged_cube_levels(int grid_levels) {
  return std::min(kJudgedCubeLevels, grid_levels);
}

class JudgedCube {
 public:
  void clear() { bricks_.fill(0); }
  Brick brick(uint64_t code) const { return bricks_[code]; }
  void set_brick(uint64_t code, Brick brick) { bricks_[code] = brick; }
  // Sets the voxels of a run, given relative to the cube's corner.
  void set(const CellRun& run) {
    LatticePoint p = run.first;
    for (int64_t i = 0; i < run.count; ++i, ++p[run.axis]) {
      const unsigned x = unsigned(p.x), y = unsigned(p.y), z = unsigned(p.z);
      const unsigned code = kSpread[x >> 2] << 2 | kSpread[y >> 2] << 1 | kSpread[z >> 2];
      bricks_[code] |= Brick(1) << brick_bit(x & 3, y & 3, z & 3);
    }
  }

 private:
  static constexpr std::array<uint16_t, 16> kSpread = [] {
    std::array<uint16_t, 16> table{};
    for (unsigned i = 0; i < 16; ++i)
      table[i] = uint16_t((i & 1) | (i & 2) << 2 | (i & 4) << 4 | (i & 8) << 6);
    return table;
  }();

  std::array<Brick, 4096> bricks_{};
};

// Writes the bricks of the sub-DAG at `node` of `level` to cube codes from `code` on.
inline void fill_cube(const DagView& dag, uint32_t level, uint32_t node, uint64_t code,
                      JudgedCube* cube) {
  if (level == dag.brick_level()) return cube->set_brick(code, dag.bricks[node]);
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t child = dag_child(dag, level, node, c);
    if (child != kNoChild) fill_cube(dag, level + 1, child, code << 3 | c, cube);
  }
}

}  // namespace svdag
