#include "builder/reduce/baked_run.h"

#include "streaming/counts.h"

namespace svdag {

void RunSet::add(BakedRun baked) {
  for (SubDagRoot& root : baked.roots) {
    root.run = as_u32(runs.size(), "runs");
    roots.push_back(root);
  }
  voxels += baked.voxels;
  if (baked.layer_voxels.size() > layer_voxels.size())
    layer_voxels.resize(baked.layer_voxels.size());
  for (size_t i = 0; i < baked.layer_voxels.size(); ++i) layer_voxels[i] += baked.layer_voxels[i];
  if (baked.run.bricks.spilled) {
    spilled = true;
    spilled_bytes += baked.run.bricks.spilled->bytes;
    for (const auto& level : baked.run.nodes) spilled_bytes += level.spilled->bytes;
  }
  runs.push_back(std::move(baked.run));
}

}  // namespace svdag
