// A grid of cubes as a limited child sends it (streaming/process/limited_child.h), and as it is
// kept.
//
// The first block is a CubeHead and the grid's name; all later ones are CubeRecords. They are
// treated as input from a hostile program: impossible types, names, transforms, sides and positions
// are an Error (kBadInput), and so are two cubes that hold the same voxel, and more cubes than a
// file of that size can hold.
//
// A full cube takes 16 bytes, so that a tree node full of tiles (32,768 of them, from 8 KB of masks
// in the file) cannot exhaust memory; a leaf takes 80. Both are kept in the order of OpenVDB's
// tree, in which they arrive, so that a voxel is found without an index.
#pragma once

#include <span>
#include <vector>

#include "io/formats/vdb.h"

namespace svdag {

enum class CubeType : uint32_t { kMask = 0, kBool = 1, kFloat = 2 };

struct CubeHead {
  CubeType type;
  uint32_t name_bytes;  // that follow this, kLongestName at most
  std::array<double, 3> origin;
  std::array<std::array<double, 3>, 3> axes;  // axes[a]: one step along index axis a

  static constexpr uint32_t kLongestName = 255;
};

struct CubeRecord {
  std::array<int32_t, 3> origin;  // multiples of the side
  uint32_t side;                  // 8, 128 or 4096
  std::array<uint64_t, 8> words;  // of a Block, not empty; without a meaning if the side is larger
};

class SentCubes final : public VdbGrid {
 public:
  // What is kept takes `most` bytes at most. Errors name `path`.
  SentCubes(const std::string& path, uint64_t most) : path_(path), most_(most) {}

  // The next block, of which records are not cut.
  void take(std::span<const std::byte> block);
  // Everything has arrived; the queries below are valid from now on.
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

  void take_head(std::span<const std::byte> block);
  void add(const CubeRecord& record);
  void check_overlap() const;
  // The tile that holds the voxel; null if none does.
  const Tile* tile_at(const LatticePoint& voxel) const;
  [[noreturn]] void fail_head() const;

  std::string path_;
  uint64_t most_;
  bool has_head_ = false;
  CubeType type_ = CubeType::kMask;
  std::string name_;
  IndexToWorld centres_;
  VoxelBox bounds_;
  std::vector<Tile> tiles_;
  std::vector<CubeRecord> leaves_;  // not full
};

}  // namespace svdag
