// Triangles that do not fit in memory, spilled by the octree cubes that they meet.
//
// A bin is a cube and the stream of its triangles. Many bins are filled at once, in one pass; each
// is then baked by itself, or dealt into bins of its sub-cubes. The stream begins with a byte, the
// size of its ring of vertices (builder/split/vertex_ring.h) as a power of two. A triangle is
//
//   2 * distance of corner 0 + is-kind-stored, [kind, [its cut]], [vertex 0],
//   distance of corner 1, [vertex 1], distance of corner 2, [vertex 2]
//
// A distance of 0 is followed by the vertex, three differences to the corner before it; of corner
// 0, to the newest vertex. The kind is stored where it changes, and of all triangles that are cut.
// Every number takes as few bytes as it needs (LEB128; of the zigzag code where it has a sign): a
// triangle of a scan at 16K takes about 11 bytes, one that shares no vertex 44, in memory 80.
// Rejected: zstd over that (two fifths less, but at 200 MB/s slower than a disk).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "builder/octree/morton.h"
#include "builder/overlap/triangle_setup.h"
#include "builder/split/vertex_ring.h"
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
    std::optional<VertexFinder> vertices;
    int64_t kind = 0;  // of the newest triangle
    uint64_t triangles = 0;
    LatticeBox box;  // bounding box of the triangles
  };

  void deal(const LatticeTriangle& triangle, const CutRecord* cut, const TriangleSetup& setup,
            const Cube& cube);
  void append(const Cube& cube, const LatticeTriangle& triangle, const CutRecord* cut,
              const LatticeBox& box);
  void write(OpenBin* bin, std::span<const std::byte> bytes);
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
  uint64_t read_code();
  int64_t read_number();
  LatticePoint read_corner(uint64_t distance, const LatticePoint& before);
  CutRecord read_cut();
  uint8_t read_byte();

  SpillReader reader_;
  MemoryBudget* budget_;
  std::optional<VertexRing> vertices_;  // from the first triangle on
  int64_t kind_ = 0;                    // of the newest triangle
  uint64_t left_;
  size_t materials_;
  const uint8_t* at_ = nullptr;
  const uint8_t* end_ = nullptr;
};

}  // namespace svdag
