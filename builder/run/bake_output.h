// The output file of a merge: a `.svdag`, or a `.run` that is merged again.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "builder/octree/grid_part.h"
#include "builder/octree/sub_dag_root.h"
#include "io/dag/write/dag_writer.h"

namespace svdag {

class BakeOutput {
 public:
  virtual ~BakeOutput() = default;
  // Levels are written from L-2 to 0, each once, with ascending, unique keys, in pieces
  // (io/dag/write/level_piece.h): encode() adds keys to a piece, append() returns the index by
  // which the level above refers to its first key, store() completes it. Indices ascend. One thread
  // at a time appends; any may encode and store.
  virtual void begin_level(int level) = 0;
  virtual void encode(std::span<const Brick> bricks, LevelPiece* piece) const = 0;
  virtual void encode(std::span<const NodeKey> nodes, LevelPiece* piece) const = 0;
  virtual uint32_t append(LevelPiece* piece) = 0;
  virtual void store(LevelPiece* piece) = 0;
  // Completes the file and gives it its name. `roots`: the non-empty tops of the part, of the union
  // and of layer i of `layers`, by their subjects. The roots of `layers` need not be set.
  virtual void finish(std::span<const SubDagRoot> roots, uint64_t voxels, double largest_snap,
                      LayerTable layers) = 0;

  // Of the finished file.
  virtual std::vector<uint64_t> key_counts() const = 0;  // per level; the last entry counts bricks
  virtual uint64_t file_bytes() const = 0;
  virtual std::string content_hash() const = 0;  // 32 hex digits
};

class DagOutput final : public BakeOutput {
 public:
  // `room`: for the compact layout.
  DagOutput(const std::string& path, const Grid& grid, Rule rule, Layout layout = Layout::kPlain,
            const WorkRoom& room = {})
      : writer_(path, grid, rule, layout == Layout::kCompact ? std::optional(room) : std::nullopt) {
  }

  void begin_level(int level) override { writer_.begin_level(level); }
  void encode(std::span<const Brick> bricks, LevelPiece* piece) const override {
    writer_.encode(bricks, piece);
  }
  void encode(std::span<const NodeKey> nodes, LevelPiece* piece) const override {
    writer_.encode(nodes, piece);
  }
  uint32_t append(LevelPiece* piece) override { return writer_.append(piece); }
  void store(LevelPiece* piece) override { writer_.store(piece); }
  void finish(std::span<const SubDagRoot> roots, uint64_t voxels, double largest_snap,
              LayerTable layers) override;
  const Header& header() const { return writer_.header(); }
  std::vector<uint64_t> key_counts() const override;
  uint64_t file_bytes() const override { return writer_.header().file_bytes; }
  std::string content_hash() const override;

 private:
  DagWriter writer_;
};

// Error (kUsage) unless `path` ends in ".svdag", or in ".run" if that is allowed.
void require_dag_name(const std::string& path, bool may_be_run = true);

// Whether `path` names a run, that is, ends in ".run".
bool names_run(const std::string& path);

// Opens the output for `part`, a `.run` or a `.svdag` by its name. A `.svdag` holds the whole grid.
// Error (kUsage) for a `.run` of another than the plain layout.
std::unique_ptr<BakeOutput> open_output(const std::string& path, const Grid& grid, Rule rule,
                                        const GridPart& part, Layout layout, const WorkRoom& room);

}  // namespace svdag
