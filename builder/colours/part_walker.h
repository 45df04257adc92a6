// Walks the parts of a bin: DAG and triangles together, down to the colour level. One walker per
// worker, with the memory of its lists.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "builder/colours/covered_node.h"
#include "builder/colours/cube_sum.h"
#include "builder/colours/prepared_triangles.h"
#include "builder/colours/untouched_nodes.h"

namespace svdag {

// A part of a bin, which one worker walks.
struct Part {
  CoveredNode node;
  TriangleList list;
  std::vector<CubeColour> colours;  // the result
};

struct WalkCounts {
  uint64_t pairs = 0, cubes_by_points = 0;
};

class PartWalker {
 public:
  // The walk does not end above this level, so that there each covered cube is seen to have a
  // triangle, also in scenes of one colour.
  static constexpr int kComparedLevel = 7;

  PartWalker(const DagView& dag, const Grid& grid, Rule rule, int level, UntouchedNodes* untouched);

  void walk(const PreparedTriangles& triangles, Part* part);
  const WalkCounts& counts() const { return counts_; }

  // Adds the triangles of `list` that meet the cube. `nearest`: their nearest points as well.
  void add(const PreparedTriangles& triangles, const Cube& cube, const TriangleList& list,
           bool nearest, CubeSum* sum);
  // The entry of a cube of the colour level.
  void end_cube(const CoveredNode& node, const CubeSum& sum, std::vector<CubeColour>* out);

  // If the triangles of `list` end the walk at `node`, appends its entry.
  bool ends(const PreparedTriangles& triangles, const CoveredNode& node, const TriangleList& list,
            std::vector<CubeColour>* out);

 private:
  void visit(const CoveredNode& node, const TriangleList& list);
  // Makes one entry of those from `first` on, if all are children of `node` of one constant colour.
  void join(const CoveredNode& node, size_t first);

  const DagView& dag_;
  int levels_;
  bool is_solid_;
  int level_;
  UntouchedNodes* untouched_;
  std::vector<std::array<TriangleList, 8>> lists_;  // [level]: of the children there
  std::vector<size_t> members_;                     // of the cube being added
  const PreparedTriangles* triangles_ = nullptr;
  std::vector<CubeColour>* out_ = nullptr;
  WalkCounts counts_;
};

}  // namespace svdag
