// A VDB grid received as a stream of cubes from a decoder in a limited child process
// (streaming/process/limited_child.h).
//
// The first block of the stream is a CubeHeader followed by the grid's name; all later blocks are
// CubeRecords. The sender is not trusted: impossible types, names, transforms, sides and positions
// are an Error (kBadInput), and so are two cubes with a common voxel, and more cubes than a file of
// that size can hold.
//
// A full cube takes 16 bytes, so that a tree node full of tiles (32,768 of them, from 8 KB of masks
// in the file) cannot exhaust memory; a leaf takes 80. Both are stored in the order of OpenVDB's
// tree, the order of arrival, so a voxel is found without an index.
#pragma once

#include <span>
#include <vector>

#include "io/formats/vdb.h"

namespace svdag {

enum class CubeValueType : uint32_t { kMask = 0, kBool = 1, kFloat = 2 };

struct CubeHeader {
  CubeValueType type;
  uint32_t name_bytes;  // that follow the header, at most kMaxNameBytes
  std::array<double, 3> origin;
  std::array<std::array<double, 3>, 3> axes;  // axes[a]: one step along index axis a

  static constexpr uint32_t kMaxNameBytes = 255;
};

struct CubeRecord {
  std::array<int32_t, 3> origin;  // multiples of the side
  uint32_t side;                  // 8, 128 or 4096
  std::array<uint64_t, 8> words;  // of a non-empty Block; ignored if the side is larger
};

class DecodedGrid final : public VdbGrid {
 public:
  // The stored cubes take at most `max_bytes` bytes. Errors name `path`.
  DecodedGrid(const std::string& path, uint64_t max_bytes) : path_(path), max_bytes_(max_bytes) {}

  // Processes the next block; a record never spans two blocks.
  void receive(std::span<const std::byte> block);
  // Ends the stream: sorts and checks the cubes. The functions below require it.
  void finish();

  std::string name() const override { return name_; }
  std::string type() const override;
  const IndexToWorld& centres() const override { return centres_; }
  VoxelBox bounds() const override { return bounds_; }
  bool visit(const VoxelCubeSink& sink) const override;
  bool get(const LatticePoint& voxel) const override;

 private:
  struct Tile {
    std::array<int32_t, 3> origin;
    uint32_t side;
  };

  void receive_header(std::span<const std::byte> block);
  void add(const CubeRecord& record);
  void check_overlap() const;
  // The tile that contains the voxel, or null.
  const Tile* tile_at(const LatticePoint& voxel) const;
  [[noreturn]] void fail_malformed() const;

  std::string path_;
  uint64_t max_bytes_;
  bool has_header_ = false;
  CubeValueType type_ = CubeValueType::kMask;
  std::string name_;
  IndexToWorld centres_;
  VoxelBox bounds_;
  std::vector<Tile> tiles_;
  std::vector<CubeRecord> leaves_;  // not full
};

}  // namespace svdag
