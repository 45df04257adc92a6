// Triangles that do not fit in memory, spilled by the cubes of the octree that they meet.
//
// A bin is a cube and the stream of its triangles. Bins are filled many at a time, in one pass, and
// each is baked by itself, or dealt into bins of its parts. A triangle is stored as nine numbers,
// the first vertex and the ways to the others, in as few bytes as each needs (LEB128 of the zigzag
// code): about 40 bytes for those of a scan at 16K, instead of 72.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "builder/octree/morton.h"
#include "builder/overlap/triangle_setup.h"
#include "builder/workspace/scratch.h"
#include "io/triangle.h"

namespace svdag {

struct TriangleBin {
  Cube cube;          // as small as the triangles allow
  MortonRange range;  // of the cube that the bin was made for; outside of `cube` it is empty
  uint64_t triangles = 0;
  SpillStream stream;
};

// Deals triangles into the bins of `parent`'s parts `depth` levels below it.
class TriangleBins {
 public:
  static constexpr int kDeepest = 3;

  TriangleBins(const Grid& grid, const Cube& parent, int depth, SpillFile* file, Scratch* scratch);

  // The deepest that `bytes` of open blocks and the grid allow.
  static int depth_for(uint64_t bytes, const Scratch& scratch, const Grid& grid,
                       const Cube& parent);

  // A triangle whose box meets the closed parent.
  void add(const LatticeTriangle& triangle);
  // Size of the triangles so far in bins: a large one is stored in each bin that it meets.
  uint64_t bytes() const { return bytes_; }
  // The bins that triangles met, in Morton order.
  std::vector<TriangleBin> finish();

 private:
  struct Open {
    std::optional<SpillWriter> writer;
    uint64_t triangles = 0;
    LatticeBox box;  // of the triangles' boxes
  };

  void deal(const LatticeTriangle& triangle, const TriangleSetup& setup, const Cube& cube);
  void append(const Cube& cube, const LatticeTriangle& triangle, const LatticeBox& box);
  Cube shrink(const Cube& cube, const Open& bin) const;

  Grid grid_;
  Cube parent_;
  int bin_level_;
  SpillFile* file_;
  Scratch* scratch_;
  std::vector<Open> bins_;  // in Morton order
  uint64_t bytes_ = 0;
};

// Reads the triangles of a bin in the order in which they were added. Bytes that are not lattice
// triangles are treated as a damaged block, since plans are copied between machines.
class BinReader {
 public:
  BinReader(SpillFile* file, const TriangleBin& bin, MemoryBudget* budget);

  // Up to `most` more triangles, appended to *out; false at the end.
  bool read(size_t most, std::vector<LatticeTriangle>* out);

 private:
  int64_t number();
  uint8_t byte();

  SpillReader reader_;
  uint64_t left_;
  const uint8_t* at_ = nullptr;
  const uint8_t* end_ = nullptr;
};

}  // namespace svdag
