#include "io/dag/layers/layer_alone.h"

#include <algorithm>

#include "io/dag/dag_writer.h"
#include "streaming/memory/rank_bitmap.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// [level]: the indices of the nodes that the root reaches, of the bricks last.
std::vector<RankBitmap> reached_nodes(const DagView& dag, MemoryBudget* budget) {
  std::vector<RankBitmap> reached;
  for (uint32_t level = 0; level <= dag.brick_level(); ++level)
    reached.emplace_back(budget, "nodes of a layer");
  if (!dag.empty()) reached[0].set(0);
  for (uint32_t level = 0; level < dag.brick_level(); ++level) {
    check_interrupt();
    reached[level].seal();
    reached[level].for_each([&](uint32_t node) {
      dag_for_children(dag, level, node,
                       [&](unsigned, uint32_t child) { reached[level + 1].set(child); });
    });
  }
  reached.back().seal();
  return reached;
}

}  // namespace

DagFile layer_alone(const DagFile& file, std::optional<size_t> layer, const WorkRoom& room) {
  SVDAG_ASSERT(file.layout() == Layout::kPlain);
  const DagView dag = layer ? file.view_of(*layer) : file.view();
  const uint64_t voxels = layer ? file.layers().layers[*layer].voxels : file.header().voxels;
  const std::vector<RankBitmap> reached = reached_nodes(dag, room.budget);
  DagWriter writer(room.folder + "/layer.svdag", file.grid(), file.rule());
  WorkArray<uint32_t> below, here;  // [rank]: index in the new file
  for (uint32_t level = dag.brick_level() + 1; level-- > 0; below = std::move(here)) {
    writer.begin_level(int(level));
    here = WorkArray<uint32_t>(reached[level].count(), room);
    uint64_t rank = 0;
    reached[level].for_each([&](uint32_t node) {
      if (level == dag.brick_level()) {
        here[rank++] = writer.add_brick(dag.bricks[node]);
        return;
      }
      NodeKey key{};
      dag_for_children(dag, level, node, [&](unsigned c, uint32_t child) {
        key[c] = 1 + below[reached[level + 1].rank(child)];
      });
      here[rank++] = writer.add_node(key);
    });
  }
  return writer.finish_unnamed(voxels, file.header().largest_snap, {}, file.path());
}

}  // namespace svdag
