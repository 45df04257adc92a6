// Triangles that do not fit in memory, spilled by the octree cubes that they meet.
//
// A bin is a cube and the stream of its triangles. Many bins are filled at once, in one pass; each
// is then baked by itself, or dealt into bins of its sub-cubes. A triangle is stored as nine
// numbers, its first vertex and the differences to the others, and its kind, each in as few
// bytes as it needs (LEB128 of the zigzag code): about 41 bytes for a scan at 16K, instead of 80.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "builder/octree/morton.h"
#include "builder/overlap/triangle_setup.h"
#include "builder/workspace/scratch.h"
#include "io/scene/cutouts/cut_records.h"
#include "io/triangle.h"

namespace svdag {

struct TriangleBin {
  Cube cube;          // the smallest cube that holds all voxels they can set
  MortonRange range;  // of the original cube of the bin, which is empty outside of `cube`
  uint64_t triangles = 0;
  SpillStream stream;
};

// Deals triangles into bins: the cubes `depth` levels below `parent`.
class TriangleBins {
 public:
  static constexpr int kMaxDepth = 3;

  TriangleBins(const Grid& grid, const Cube& parent, int depth, SpillFile* file, Scratch* scratch);

  // The largest depth for which the open blocks take at most `bytes`, and that the grid allows.
  static int depth_for(uint64_t bytes, const Scratch& scratch, const Grid& grid,
                       const Cube& parent);

  // Adds a triangle whose box meets the closed parent. `cut`: its record if it is cut, else null.
  void add(const LatticeTriangle& triangle, const CutRecord* cut = nullptr);
  // Bytes of all bins so far; a triangle counts in each bin that it meets.
  uint64_t bytes() const { return bytes_; }
  // Returns the bins that hold triangles, in Morton order.
  std::vector<TriangleBin> finish();

 private:
  struct OpenBin {
    std::optional<SpillWriter> writer;
    uint64_t triangles = 0;
    LatticeBox box;  // bounding box of the triangles
  };

  void deal(const LatticeTriangle& triangle, const CutRecord* cut, const TriangleSetup& setup,
            const Cube& cube);
  void append(const Cube& cube, const LatticeTriangle& triangle, const CutRecord* cut,
              const LatticeBox& box);
  Cube shrink(const Cube& cube, const OpenBin& bin) const;

  Grid grid_;
  Cube parent_;
  int bin_level_;
  SpillFile* file_;
  Scratch* scratch_;
  std::vector<OpenBin> bins_;  // in Morton order
  uint64_t bytes_ = 0;
};

// Reads the triangles of a bin, in the order in which they were added. Bytes that do not decode to
// triangles on the lattice are reported like a damaged block, since the files of a plan may come
// from elsewhere.
class BinReader {
 public:
  // `materials`: that cut triangles may have.
  BinReader(SpillFile* file, const TriangleBin& bin, MemoryBudget* budget, size_t materials = 0);

  // Appends up to `max_count` further triangles to *out, and the records of those that are cut to
  // *cuts; false at the end.
  bool read(size_t max_count, std::vector<LatticeTriangle>* out, CutRecords* cuts);

 private:
  int64_t read_number();
  CutRecord read_cut();
  uint8_t read_byte();

  SpillReader reader_;
  uint64_t left_;
  size_t materials_;
  const uint8_t* at_ = nullptr;
  const uint8_t* end_ = nullptr;
};

}  // namespace svdag
