// Writes a `.run` level by level, bricks first, in one sequential pass (docs/run-format.md).
//
// The bytes are canonical: they depend only on the grid, the rule, the part and the voxels in it.
//   The sub-DAG of a cube is minimal and therefore unique, and the cubes with roots follow from the
//   part (its tops, builder/octree/grid_part.h), not from how it was baked.
//   Every node is reached from a root, since a merge of closed runs adds no unreachable nodes.
//   Nodes are numbered by their rank in content order; roots and ranges are in Morton order.
//   The largest snap move is over all triangles that meet the closed part, so the maximum over the
//   parts is the move of the whole (GridPart::meets).
//   Blocks are filled without gaps, and neither times nor the names of users, hosts or programs are
//   stored.
// So the content hash identifies the content, whatever threads, memory or tree of merges produced
// it.
// Rejected: compressed blocks (their bytes would depend on the version of the compressor).
#pragma once

#include <string>
#include <vector>

#include "builder/run/bake_output.h"
#include "builder/run/run_format.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/block_filler.h"

namespace svdag {

class RunWriter final : public BakeOutput {
 public:
  RunWriter(const std::string& path, const Grid& grid, Rule rule, GridPart part);

  void begin_level(int level) override;
  void encode(std::span<const Brick> bricks, LevelPiece* piece) const override;
  void encode(std::span<const NodeKey> nodes, LevelPiece* piece) const override;
  uint32_t append(LevelPiece* piece) override;
  void store(LevelPiece* piece) override { store(&piece->filled); }
  void finish(std::span<const SubDagRoot> roots, uint64_t voxels, double largest_snap,
              LayerTable layers) override;

  std::vector<uint64_t> key_counts() const override;
  uint64_t file_bytes() const override { return header_.file_bytes; }
  std::string content_hash() const override;

 private:
  void append(const void* bytes, size_t size);
  void store(FilledBlocks* filled);
  void align();
  void append_roots(std::span<const SubDagRoot> roots);
  void append_layers(const LayerTable& layers);

  AtomicFile file_;
  GridPart part_;
  RunHeader header_{};
  int level_;
  NodeKey last_{};  // the last key of the level
  BlockFiller blocks_{kRunBlockBytes, kSpillHeader};
  FilledBlocks filled_;  // by append(bytes, size)
};

}  // namespace svdag
