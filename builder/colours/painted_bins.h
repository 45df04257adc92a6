// Painted triangles that do not fit in memory, spilled by the octree cubes that they meet.
#pragma once

#include <optional>
#include <vector>

#include "builder/colours/painted_triangle.h"
#include "builder/octree/octree_cube.h"
#include "builder/overlap/triangle_setup.h"
#include "builder/workspace/scratch.h"

namespace svdag {

struct PaintedBin {
  Cube cube;
  uint64_t triangles = 0;
  SpillStream stream;
};

// Deals triangles into bins: the cubes `depth` levels below `parent`.
class PaintedBins {
 public:
  static constexpr int kMaxDepth = 3;

  // The depth, 1 to `most`, for which the open blocks take at most `bytes`.
  static int depth_for(uint64_t bytes, int most, const Scratch& scratch) {
    int depth = 1;
    while (depth < std::min(most, kMaxDepth) && scratch.block_bytes() << (3 * (depth + 1)) <= bytes)
      ++depth;
    return depth;
  }

  PaintedBins(int levels, const Cube& parent, int depth, Scratch* scratch);

  // Adds a triangle whose box meets the closed parent.
  void add(const PaintedTriangle& t);
  // The bins that hold triangles, in Morton order.
  std::vector<PaintedBin> finish();

 private:
  struct OpenBin {
    std::optional<SpillWriter> writer;
    uint64_t triangles = 0;
  };

  void deal(const PaintedTriangle& t, const TriangleSetup& setup, const Cube& cube);
  void append(const Cube& cube, const PaintedTriangle& t);

  int levels_;
  Cube parent_;
  int depth_;
  Scratch* scratch_;
  std::vector<OpenBin> bins_;  // in Morton order
};

// Reads the triangles of a bin.
class PaintedReader {
 public:
  PaintedReader(SpillFile* file, const PaintedBin& bin, MemoryBudget* budget)
      : reader_(file, bin.stream, budget), left_(bin.triangles) {}

  // False at the end.
  bool read(PaintedTriangle* t);

 private:
  template <class Value>
  void get(Value* value);

  SpillReader reader_;
  uint64_t left_;
  std::span<std::byte> block_;
};

}  // namespace svdag
