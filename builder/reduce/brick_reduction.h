// Reduces bricks and full cubes that arrive in Morton order: the octree of an import.
//
// Only the path to the last brick is open in the builder (builder/reduce/sub_dag_builder.h); all
// that precedes it is in the node table. With layers, each cube of the path holds the children of
// every set in it; where only one layer is, its nodes and the union's are the same entries of the
// table.
#pragma once

#include <span>

#include "builder/reduce/sub_dag_builder.h"

namespace svdag {

// The voxels of a brick that are of one set.
struct SubjectBrick {
  Subject subject;
  Brick brick;  // not zero
};

class BrickReduction {
 public:
  explicit BrickReduction(SubDagBuilder* builder, bool has_layers = false);

  // Adds a brick that is not zero. `code`: Morton code of its position in bricks; ascending.
  void add(uint64_t code, Brick brick);
  // The same with layers: the brick of the union, and of each layer.
  void add(uint64_t code, std::span<const SubjectBrick> bricks);
  // Without layers: adds a cube of `level` < levels - 2 whose voxels are all set. `code`: Morton
  // code of its position among the cubes of its level; it follows all that was added before.
  void add_full(uint64_t code, int level);
  // Completes the root. Nothing may be added after it.
  void finish();

 private:
  uint64_t code_at(int level) const { return code_ >> (3 * (brick_level_ - level)); }
  void open(const Cube& cube);
  void open_path(uint64_t code, int level);
  SubDag full_cube(int level);
  void pause(uint64_t code, int level);

  SubDagBuilder* builder_;
  const int brick_level_;
  const bool has_layers_;
  int open_ = 0;       // level of the last cube of the open path
  uint64_t code_ = 0;  // Morton code of a brick in it
};

}  // namespace svdag
