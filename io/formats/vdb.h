// OpenVDB grids (.vdb) and NanoVDB grids (.nvdb), leaf by leaf.
//
// A grid of VDB (Museth 2013) is a tree of fixed depth over infinite index space: leaves of 8^3
// voxels, below nodes of 128^3 and of 4096^3, each of which may also hold a tile, one value for a
// whole child. Our blocks are such leaves bit by bit, our full cubes become tiles and tiles become
// cubes, so nothing is ever expanded into single voxels.
//
// Voxel (i, j, k) of a VDB grid has its *centre* at transform(i, j, k), where ours have their
// corner: IndexToWorld speaks of centres on both sides, and voxel_centres() puts ours half a voxel
// further.
//
// OpenVDB's headers take 45 s and 0.9 GB per source file, so they are named in vdb*.cpp alone; no
// type of theirs is named here. Its writer does not notice a full disk: what was written is read
// again and compared before the file gets its name.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "io/dag/voxel_cube.h"
#include "io/formats/value_range.h"

namespace svdag {

// World position of a voxel's centre: origin + i * axes[0] + j * axes[1] + k * axes[2].
struct IndexToWorld {
  Point origin{0};
  std::array<Point, 3> axes{};

  Point operator()(const Point& p) const {
    return origin + p.x * axes[0] + p.y * axes[1] + p.z * axes[2];
  }
  bool operator==(const IndexToWorld&) const = default;
};

// Of the voxels of `grid`.
IndexToWorld voxel_centres(const Grid& grid);

enum class VdbFormat {
  kMask,  // .vdb, grids of type mask: a voxel is active or not
  kBool,  // .vdb, grids of type bool, active and true: for readers that know no masks
  kNano,  // .nvdb, one grid of type mask
};

using VdbMetadata = std::map<std::string, std::string>;

// Sets of voxels on their way into a file.
class VdbWriter {
 public:
  virtual ~VdbWriter() = default;
  // A new grid; what is added later goes into it.
  virtual void begin(const std::string& name, const IndexToWorld& centres) = 0;
  virtual void metadata(const VdbMetadata& entries) = 0;
  // The cube's origin is a multiple of 8; of a larger cube a multiple of its side or of 4096.
  virtual void add(const VoxelCube& cube) = 0;
  virtual void add_voxel(const LatticePoint& voxel) = 0;
  // Puts everything into a file under the name `path`, whole or not at all; a full disk is an Error
  // (kOutput).
  virtual void write(const std::string& path, VdbFormat format) = 0;
};

// In a build without OpenVDB this is an Error (kUsage), and so is read_vdb().
std::unique_ptr<VdbWriter> make_vdb_writer();

// Upper bound on the bytes that a VdbWriter needs for so many leaves and nodes, writing included.
uint64_t vdb_bytes(uint64_t leaves, uint64_t nodes_of_128, uint64_t nodes_of_4096);

// A grid that was read. A voxel is set iff it is active (mask), active and true (bool), or has a
// value in the range, active or not (float).
class VdbGrid {
 public:
  virtual ~VdbGrid() = default;
  virtual std::string name() const = 0;
  virtual std::string type() const = 0;  // "mask", "bool", "float"
  virtual const IndexToWorld& centres() const = 0;
  virtual VoxelBox bounds() const = 0;  // of set voxels
  // Leaves and tiles (of 8^3, 128^3, 4096^3) in which something is set, each voxel in one of them,
  // until the sink returns false.
  virtual bool visit(const VoxelCubeSink& sink) const = 0;
  virtual bool get(const LatticePoint& voxel) const = 0;
};

// Error (kUsage) if a range was given for a grid that holds no values.
void refuse_needless_range(const VdbGrid& grid, const std::optional<ValueRange>& range);

// Reads grid `name`, or the only one if that is empty, in a child process with limits on memory and
// time (streaming/process/limited_child.h); `sandbox`: in one that can only compute. Broken files,
// other types and transforms that are not linear are an Error (kBadInput); a float grid without a
// range is one (kUsage).
std::unique_ptr<VdbGrid> read_vdb(const std::string& path, const std::string& name,
                                  const std::optional<ValueRange>& range, bool sandbox = false);

}  // namespace svdag
