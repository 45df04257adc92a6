#include "builder/descend/voxelize_window.h"

#include "builder/overlap/overlap.h"
#include "builder/winding/winding_lines.h"

namespace svdag {
namespace {

void emit(const NodeTable& table, const Cube& cube, uint32_t node, const BrickSink& sink) {
  if (node == 0) return;
  if (cube.level == table.brick_level()) return sink(cube.coordinate, table.brick(node - 1));
  const NodeKey& children = table.node(cube.level, node - 1);
  for (unsigned c = 0; c < 8; ++c) emit(table, cube.child(c), children[c], sink);
}

}  // namespace

uint64_t voxelize_window(const Grid& grid, const DescentConfig& config, const Cube& window,
                         std::span<const LatticeTriangle> triangles, const BrickSink& sink,
                         MemoryBudget* budget, const CutRecords* cuts) {
  MemoryBudget unlimited;
  SubDagBuilder builder(grid.levels, {.budget = budget != nullptr ? budget : &unlimited});
  std::vector<TriangleSetup> setups;
  setups.reserve(triangles.size());
  TriangleList list;
  const LatticeBox closed = window.closed(grid.levels);
  for (const LatticeTriangle& triangle : triangles) {
    setups.push_back(make_setup(triangle));
    setups.back().triangle.subject = kUnionSet;
    if (setups.back().box.meets(closed)) list.push_back({&setups.back(), setups.back().edges});
  }
  int32_t winding = 0;
  if (is_solid(config.rule)) {
    const WindingLines lines(grid.levels, window, window.level);
    for (const LatticeTriangle& triangle : triangles) winding += lines.ray_change(triangle);
  }
  Descent descent(grid, config, &builder);
  if (config.cut_outs != nullptr) descent.use(cuts);
  descent.run(window, list, {{kUnionSet, winding}});
  builder.settle();
  if (builder.roots().empty()) return 0;
  emit(*builder.table(), window, 1 + builder.roots().front().rank, sink);
  return builder.voxels();
}

}  // namespace svdag
