// Synthetic colours of the covered cubes of a file, made while its DAG is walked: a source for the
// writer, in tests and benchmarks.
#pragma once

#include <functional>
#include <vector>

#include "io/dag/colours/colour_writer.h"
#include "io/dag/dag_view.h"

namespace svdag {

class PaintedCubes {
 public:
  // Sets has_colour, is_constant and linear of a cube of level K at (x, y, z).
  using Paint = std::function<void(uint32_t x, uint32_t y, uint32_t z, CubeColour* colour)>;

  PaintedCubes(const DagView& dag, uint32_t level, Paint paint)
      : dag_(dag), level_(level), paint_(std::move(paint)) {
    if (!dag.empty()) stack_.push_back({});
  }

  CubeColourSource source() {
    return [this]() -> std::span<const CubeColour> {
      part_.clear();
      while (part_.size() < 4096 && !stack_.empty()) step();
      return part_;
    };
  }

 private:
  struct Cube {
    uint32_t level = 0, index = 0, x = 0, y = 0, z = 0;
    uint64_t bits = 0;  // of an octant of a brick, or 1
  };

  void step() {
    const Cube cube = stack_.back();
    stack_.pop_back();
    if (cube.level == level_) {
      CubeColour colour{0, uint8_t(level_), true, false, {}};
      for (uint32_t bit = 0; bit < level_; ++bit)
        colour.morton |= uint64_t(octant_of(cube.x, cube.y, cube.z, bit)) << 3 * bit;
      paint_(cube.x, cube.y, cube.z, &colour);
      part_.push_back(colour);
      return;
    }
    for (unsigned c = 8; c-- > 0;) {
      Cube child{cube.level + 1,       0, 2 * cube.x + (c >> 2), 2 * cube.y + (c >> 1 & 1),
                 2 * cube.z + (c & 1), 1};
      if (cube.level < dag_.brick_level()) {
        child.index = dag_child(dag_, cube.level, cube.index, c);
        if (child.index == kNoChild) continue;
      } else {
        child.bits = cube.level == dag_.brick_level() ? dag_.bricks[cube.index] >> 8 * c & 0xff
                                                      : cube.bits >> c & 1;
        if (child.bits == 0) continue;
      }
      stack_.push_back(child);
    }
  }

  const DagView& dag_;
  const uint32_t level_;
  const Paint paint_;
  std::vector<Cube> stack_;
  std::vector<CubeColour> part_;
};

// A texture in blocks of 2^shift cubes: plain walls, cubes without colour, shades with fine and
// coarse grain.
inline PaintedCubes::Paint mixed_paint(uint32_t shift) {
  return [shift](uint32_t x, uint32_t y, uint32_t z, CubeColour* colour) {
    const uint32_t block = (x >> shift) * 7 + (y >> shift) * 3 + (z >> shift);
    const uint32_t kind = block % 6;
    colour->has_colour = kind != 1;
    colour->is_constant = kind == 0 || kind == 2;
    const uint32_t grain = (x * 2654435761U ^ y * 40503U ^ z * 69069U) * 2246822519U >> 20;
    for (uint32_t c = 0; c < 3 && colour->has_colour; ++c) {
      const uint32_t plain = (block * (c * 977 + 3001) + c * 7919) % 50000;
      const uint32_t shade = (x * 90 + y * 70 * c + z * 50) % 12000;
      colour->linear[c] = uint16_t(
          colour->is_constant ? plain : plain + shade + grain * (kind == 3 ? 1 : 1 + kind) / 6);
    }
  };
}

}  // namespace svdag
