// Reduces disjoint cubes of the octree to sub-DAGs in one node table, and empties the table to a
// run whenever it has used its share of memory or time.
//
// The descent, dense cubes and imports all feed it: they add bricks and nodes bottom-up, and it
// owns what outlives a single cube: the table, the open path, the roots and the finished ranges.
// The *open path* holds the cubes being divided, one per level, with the children found so far.
// With layers (builder/octree/sub_dag_root.h), the cubes of the path that several layers touch hold
// children of several subjects; all below the first cube of one layer are of that layer.
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
#include <span>
#include <vector>

#include "builder/octree/morton.h"
#include "builder/reduce/baked_run.h"
#include "builder/reduce/node_table.h"

namespace svdag {

// A sub-DAG of a cube that several layers touch: one layer's, or the union's.
struct SubjectDag {
  Subject subject;
  SubDag dag;
};

struct SubDagBuilderConfig {
  MemoryBudget* budget = nullptr;     // required
  uint64_t table_bytes = UINT64_MAX;  // freeze_bytes() from which on the table is emptied
  double max_seconds = std::numeric_limits<double>::infinity();  // between two times it is emptied
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
  // Ends it: `dag` is what remains to be a root, unless parts of it became roots before.
  Pause end(const Cube& cube, const SubDag& dag) {
    add_root(cube, subject_, dag.root, dag.voxels);
    return end(cube);
  }
  Pause end(const Cube& cube, std::span<const SubjectDag> dags) {
    for (const auto& [subject, dag] : dags) add_root(cube, subject, dag.root, dag.voxels);
    return end(cube);
  }
  // Records that `range` is finished and empty.
  void note_empty(const MortonRange& range) { append_range(&finished_, range); }

  // The subject of the cubes of one layer that follow.
  void set_subject(Subject subject) { subject_ = subject; }
  // Adds `cube` to the open path. `as_roots`: its children become roots, since a part of the cube
  // was finished in an earlier run.
  void open(const Cube& cube, bool as_roots = false) {
    OpenCube& opened = path_[size_t(cube.level)];
    opened.cube = cube;
    opened.children = {};
    opened.voxels = 0;
    opened.as_roots = as_roots;
  }
  // Sets child `c` of the open cube of `level`.
  void add_child(int level, unsigned c, const SubDag& child) {
    OpenCube& parent = path_[size_t(level)];
    parent.children[c] = child.root;
    parent.voxels += child.voxels;
  }
  // Closes the open cube of `level`, the last of the path, and returns its sub-DAG.
  SubDag close(int level) {
    OpenCube& cube = path_[size_t(level)];
    if (cube.as_roots) make_roots(&cube);
    if (cube.voxels == 0) return {};
    return {table_.add_node(level, cube.children), cube.voxels};
  }
  // The same for a cube of several layers.
  void add_child(int level, unsigned c, Subject subject, const SubDag& child) {
    if (child.root != 0)
      path_[size_t(level)].of_layers.push_back({subject, uint8_t(c), child.root, child.voxels});
  }
  void close(int level, std::vector<SubjectDag>* dags);
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
  struct OpenCube {
    Cube cube;
    NodeKey children;  // 1 + handle each; 0: empty
    uint64_t voxels;   // of the children
    bool as_roots;     // the children become roots
    struct Child {
      Subject subject;
      uint8_t c;
      uint32_t root;
      uint64_t voxels;
    };
    std::vector<Child> of_layers;  // the children of a cube of several layers
  };

  bool is_late() const;
  double age() const { return std::chrono::duration<double>(Clock::now() - emptied_).count(); }
  void flush(int level);
  void reset();
  Pause end(const Cube& cube);
  void make_roots(OpenCube* cube);
  void add_root(const Cube& cube, Subject subject, uint32_t node) {
    if (node != 0) roots_.push_back({morton(cube.coordinate), cube.level, 0, node - 1, subject});
  }
  void add_root(const Cube& cube, Subject subject, uint32_t node, uint64_t voxels) {
    add_root(cube, subject, node);
    count_voxels(subject, voxels, &voxels_, &layer_voxels_);
  }

  using Clock = std::chrono::steady_clock;

  SubDagBuilderConfig config_;
  NodeTable table_;
  std::vector<OpenCube> path_;  // [level]
  Subject subject_ = kUnionSet;
  int first_level_ = 0;  // level of the cube that was begun
  std::vector<SubDagRoot> roots_;
  size_t settled_roots_ = 0;  // roots_ before this index hold table numbers
  uint64_t voxels_ = 0;
  std::vector<uint64_t> layer_voxels_;
  std::vector<MortonRange> finished_;
  uint64_t finished_end_ = 0;  // Morton code up to which the begun cube is in finished_
  Clock::time_point emptied_ = Clock::now();
};

}  // namespace svdag
