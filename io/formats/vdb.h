// Reading and writing of OpenVDB grids (.vdb), and writing of NanoVDB grids (.nvdb), leaf by leaf.
//
// A VDB grid (Museth 2013) is a tree of fixed depth over infinite index space: leaves of 8^3 voxels
// below nodes of 128^3 and of 4096^3, which may also hold tiles, one value for a whole child. Our
// blocks equal such leaves bit by bit, and our full cubes correspond to tiles, so nothing is
// expanded into single voxels.
//
// transform(i, j, k) is the *centre* of voxel (i, j, k) of a VDB grid, but the corner of ours.
// IndexToWorld maps to centres for both; voxel_centres() adds half a voxel to ours.
//
// OpenVDB's headers take up to 20 s and 1.2 GB per source file, so only the sources in
// io/formats/vdb/ include them, and this header uses none of its types. Its writer does not detect
// a full disk: a written file is read back and compared before it is renamed to its final name.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "io/dag/walk/voxel_cube.h"
#include "io/units.h"

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

// The map from the voxels of `grid` to their centres.
IndexToWorld voxel_centres(const Grid& grid);

enum class VdbFormat {
  kBool,   // .vdb, grids of type bool, active and true: every reader of VDB has them
  kMask,   // .vdb, grids of type mask: a voxel is active or not
  kFloat,  // .vdb, grids of type float, active and 1 in a background of 0: a fog volume
  kNano,   // .nvdb, one grid of type mask
};

using VdbMetadata = std::map<std::string, std::string>;

// Collects grids of voxels and writes them to a file.
class VdbWriter {
 public:
  using Light = std::array<float, 3>;

  virtual ~VdbWriter() = default;
  // Begins a new grid, to which the following calls add.
  virtual void begin(const std::string& name, const IndexToWorld& centres) = 0;
  virtual void metadata(const VdbMetadata& entries) = 0;
  // The origin is a multiple of 8; the origin of a larger cube, of its side or of 4096.
  virtual void add(const VoxelCube& cube) = 0;
  virtual void add_voxel(const LatticePoint& voxel) = 0;
  // Begins the grid of labels, of type Int32 with the background -1, to which metadata() adds from
  // now on; .nvdb has none.
  virtual void begin_labels(const std::string& name, const IndexToWorld& centres) = 0;
  // All voxels of a cube have the label. `side` is 8 or more; the origin as in add().
  virtual void add_label(const LatticePoint& origin, int64_t side, int32_t label) = 0;
  // [64x + 8y + z]: the label of a voxel of the block; what is not set has none.
  using BlockLabels = std::array<int32_t, 512>;
  virtual void add_labels(const VoxelCube& block, const BlockLabels& labels) = 0;
  // The same for a grid of colours in linear light, 0 .. 1, of type vec3s with the background 0.
  virtual void begin_colours(const std::string& name, const IndexToWorld& centres) = 0;
  virtual void add_colour(const LatticePoint& origin, int64_t side, const Light& light) = 0;
  using BlockColours = std::array<Light, 512>;
  virtual void add_colours(const VoxelCube& block, const BlockColours& colours) = 0;
  // Writes all grids to the file `path`, as a whole or not at all; a full disk is an Error
  // (kOutput).
  virtual void write(const std::string& path, VdbFormat format) = 0;
};

// Without OpenVDB in the build this is an Error (kUsage), and so is read_vdb().
std::unique_ptr<VdbWriter> make_vdb_writer();

// Upper bound on the bytes that a VdbWriter needs for these numbers of leaves and nodes, writing
// included.
uint64_t vdb_bytes(VdbFormat format, uint64_t leaves, uint64_t nodes_of_128,
                   uint64_t nodes_of_4096);
// The same for a grid of values of this size, in addition.
uint64_t vdb_value_bytes(size_t value, uint64_t leaves, uint64_t nodes_of_128,
                         uint64_t nodes_of_4096);

// A grid that was read. A voxel is set iff it is active (mask), active and true (bool), or has a
// value in the range, active or not (float).
class VdbGrid {
 public:
  virtual ~VdbGrid() = default;
  virtual std::string name() const = 0;
  virtual std::string type() const = 0;  // "mask", "bool", "float"
  virtual const IndexToWorld& centres() const = 0;
  virtual VoxelBox bounds() const = 0;  // of set voxels
  // Visits disjoint leaves and tiles (of 8^3, 128^3, 4096^3) that hold all set voxels, until the
  // sink returns false.
  virtual bool visit(const VoxelCubeSink& sink) const = 0;
  virtual bool get(const LatticePoint& voxel) const = 0;
};

// Error (kUsage) if a range was given for a grid that holds no values.
void reject_needless_range(const VdbGrid& grid, const std::optional<ValueRange>& range);

// Reads grid `name` (empty: the only one) in a child process with limits on memory and time
// (streaming/process/limited_child.h); with `sandbox` the child can only compute. Damaged files,
// other types and nonlinear transforms are an Error (kBadInput), a float grid without a range is an
// Error (kUsage).
std::unique_ptr<VdbGrid> read_vdb(const std::string& path, const std::string& name,
                                  const std::optional<ValueRange>& range, bool sandbox = false);

}  // namespace svdag
