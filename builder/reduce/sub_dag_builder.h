// Reduces disjoint cubes of the octree to sub-DAGs in one node table, and empties the table to a
// run whenever it has used its share of memory or time.
//
// The descent, dense cubes and imports all feed it: they add bricks and nodes bottom-up, and it
// owns what outlives a single cube: the table, the open path, the roots and the finished ranges.
// The *open path* holds the cubes being divided, one per level, with the children found so far.
// With layers (builder/octree/subject.h), an open cube has children of several sets; without, or
// where only one layer is, all children are of the same sets.
//
// Handles (builder/reduce/unique_set.h) are pending until a flush gives them numbers. A flush
// happens only in end() and pause(), between two cubes: then the path, the roots and the plane memo
// are all that hold handles. When the table is emptied, the children of open cubes become roots of
// their own, and so will the children that follow; the open cubes become nodes of the top tree
// (builder/merge/top_tree.h). So the result does not depend on when a table is emptied.
#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "builder/octree/morton.h"
#include "builder/reduce/baked_run.h"
#include "builder/reduce/node_table.h"

namespace svdag {

struct SubDagBuilderConfig {
  MemoryBudget* budget = nullptr;     // required
  uint64_t table_bytes = UINT64_MAX;  // freeze_bytes() from which on the table is emptied
  double max_seconds = std::numeric_limits<double>::infinity();  // between two times it is emptied
  bool with_union = true;  // false: what is only the union's is dropped
  // Empties the table, with take_run() or otherwise; null: the table is never emptied.
  std::function<void()> empty_table = nullptr;
};

class SubDagBuilder {
 public:
  // What pause() did. After kFlushed, handles held elsewhere pass through NodeTable::settled();
  // after kEmptied they are invalid.
  enum class Pause { kNone, kFlushed, kEmptied };

  // `levels`: L of the grid.
  SubDagBuilder(int levels, SubDagBuilderConfig config);

  int levels() const { return table_.levels(); }
  NodeTable* table() { return &table_; }

  // Begins a cube that no open cube holds. Such cubes are disjoint.
  void begin(const Cube& cube);
  // Ends it: the sub-DAGs that were added for it are roots.
  Pause end();
  // Records that `range` is finished and empty.
  void note_empty(const MortonRange& range) { append_range(&finished_, range); }

  // Adds `cube` to the open path. Everything added below it is of `sets`; nullopt: of several.
  // `as_roots`: its children become roots, since a part of the cube was finished in an earlier run.
  void open(const Cube& cube, std::optional<SubDagSets> sets = SubDagSets(),
            bool as_roots = false) {
    OpenCube& opened = path_[size_t(cube.level)];
    opened.cube = cube;
    opened.as_roots = as_roots;
    opened.is_of_several = !sets;
    opened.nodes.clear();
    if (sets) opened.nodes.push_back({*sets});
  }
  // Adds the sub-DAG of child `c` of the open cube of `level` - 1, the last of the path, or of the
  // cube that was begun if that is of `level`.
  void add(int level, unsigned c, SubDagSets sets, const SubDag& dag) {
    if (dag.root == 0) return;
    if (level == first_level_) return add_root(begun_, sets, dag.root, dag.voxels);
    OpenCube& parent = path_[size_t(level) - 1];
    parent.is_of_several ? add_to_several(&parent, c, sets, dag) : parent.nodes[0].add(c, dag);
  }
  // Closes the open cube of `level`, the last of the path, and adds its sub-DAGs.
  void close(int level);
  // Flushes the table if it is full or late, and empties it if it exceeds its share. To be called
  // between two cubes: `level` - 1 is the last level of the open path, and the begun cube is
  // complete before Morton code `reached`. May throw Interrupted.
  Pause pause(int level, uint64_t reached);

  // Since the table was last emptied. The ranks of the roots are table numbers once settled.
  const std::vector<SubDagRoot>& roots() const { return roots_; }
  uint64_t voxels() const { return voxels_; }  // of the roots, in the union (for progress, if none)
  // Flushes the table. No cube may be open.
  void settle() { flush(0); }
  // Freezes the table, spilled to `target` if given, and starts an empty one.
  BakedRun take_run(const SpillTarget* target);

 private:
  // The children of an open cube that are of the same sets.
  struct OpenNode {
    SubDagSets sets;
    NodeKey children = {};  // 1 + handle each; 0: empty
    uint64_t voxels = 0;    // of the children

    Subject subject() const { return sets.subject; }
    void add(unsigned c, const SubDag& dag) {
      children[c] = dag.root;
      voxels += dag.voxels;
    }
  };
  struct OpenCube {
    Cube cube;
    bool as_roots;                // the children become roots
    bool is_of_several;           // each set has a node of its own
    std::vector<OpenNode> nodes;  // one, or sorted by subject
  };

  void add_to_several(OpenCube* parent, unsigned c, SubDagSets sets, const SubDag& dag);

  bool is_late() const;
  double age() const { return std::chrono::duration<double>(Clock::now() - emptied_).count(); }
  void flush(int level);
  void reset();
  void make_roots(OpenCube* cube);
  void add_root(const Cube& cube, SubDagSets sets, uint32_t node, uint64_t voxels);

  using Clock = std::chrono::steady_clock;

  SubDagBuilderConfig config_;
  NodeTable table_;
  std::vector<OpenCube> path_;  // [level]
  Cube begun_;
  int first_level_ = 0;  // of begun_
  std::vector<SubDagRoot> roots_;
  size_t settled_roots_ = 0;  // roots_ before this index hold table numbers
  uint64_t voxels_ = 0;
  std::vector<uint64_t> layer_voxels_;
  std::vector<MortonRange> finished_;
  uint64_t finished_end_ = 0;  // Morton code up to which the begun cube is in finished_
  Clock::time_point emptied_ = Clock::now();
};

}  // namespace svdag
