// Bricks in Morton order become sub-DAGs: the octree is built and reduced as they go by.
//
// Of the octree only the path to the last brick stands in memory; what lies before it is in the
// node table. A table that has had its share of memory is frozen to a run and begins anew
// (builder/reduce/run.h): what is complete becomes roots, and the cubes of the path, whose
// parts are then in several runs, become nodes of the top tree (builder/merge/top_tree.h), exactly
// as in a bake.
#pragma once

#include <functional>
#include <vector>

#include "builder/octree/sub_dag_root.h"
#include "builder/reduce/node_table.h"
#include "builder/reduce/run.h"
#include "builder/workspace/scratch.h"

namespace svdag {

struct BrickReductionConfig {
  MemoryBudget* budget = nullptr;
  Scratch* scratch = nullptr;  // where runs are spilled
  uint64_t table_bytes = 0;    // freeze_bytes() of a table from which on it is spilled
};

class BrickReduction {
 public:
  BrickReduction(int levels, const BrickReductionConfig& config);

  // A brick that is not zero; `code`: the Morton code of its place in bricks, each above the last.
  void add(uint64_t code, Brick brick);
  // A cube of `level` < levels - 2 that is set as a whole; `code`: the Morton code of its place
  // among cubes of its level. It follows what was added and precedes what will be.
  void add_full(uint64_t code, int level);
  // No more is added. Afterwards runs and roots are complete.
  void finish();

  std::vector<Run>& runs() { return runs_; }
  std::vector<SubDagRoot>& roots() { return roots_; }
  bool spilled() const { return spilled_; }

 private:
  // A cube of the path: its children (1 + handle) so far.
  struct Step {
    NodeKey children{};
    bool divided = false;  // some of its parts became roots: the others will
  };
  // Part of the table, and its 1 + handle.
  struct Part {
    uint64_t morton;
    int level;
    uint32_t handle;
  };

  uint64_t code_at(int level) const { return code_ >> (3 * (table_.brick_level() - level)); }
  void leave_for(uint64_t code);
  void settle_if_full();
  void close(int level);
  void make_parts(int level);
  void flush();
  void freeze(bool spill);

  BrickReductionConfig config_;
  NodeTable table_;
  std::vector<Step> path_;  // [level]
  uint64_t code_ = 0;       // of the last brick
  bool any_ = false;
  std::vector<Part> parts_;  // of the table as it is
  std::vector<Run> runs_;
  std::vector<SubDagRoot> roots_;
  bool spilled_ = false;
};

}  // namespace svdag
