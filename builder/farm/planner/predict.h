// From counted work to seconds, memory and disk.
//
// The model is linear in triangles, cubes divided, nodes computed for the plane memo and nodes
// found (builder/farm/planner/survey.h); its constants were fitted to bakes of generated scenes
// alone, on one machine (tests/bench/plan.py --calibrate does it again, and judges them on other
// scenes). Seconds are those of that machine; shares between shards are right on any. Memory is no
// guess: it is what a step is allowed, and it keeps within that.
#pragma once

#include "builder/farm/plan/plan.h"
#include "builder/farm/planner/survey.h"

namespace svdag {

// Unique nodes above the bricks, and bricks.
struct NodeCounts {
  double nodes = 0, bricks = 0;

  double keys() const { return nodes + bricks; }
  double run_bytes() const { return 32 * nodes + 8 * bricks; }
};

// CPU seconds of voxelizing.
double cpu_of(const Work& work);

// What a step may have.
struct StepLimits {
  size_t threads = 1;
  uint64_t memory = 0;  // its --memory, at most
};

struct ShardWork {
  Work work;
  NodeCounts found;           // in the shard alone
  uint64_t triangles = 0;     // in the bins that it reads
  uint64_t heaviest_bin = 0;  // of them
};

Prediction predict_shard(const ShardWork& shard, const StepLimits& limits);

// A merge of runs with `read` keys to one file with `made`.
Prediction predict_merge(const NodeCounts& read, const NodeCounts& made, bool last,
                         const StepLimits& limits);

// CPU seconds of a bake in one piece, of a scene of so many triangles.
double cpu_of_bake(const Work& work, const NodeCounts& found, uint64_t triangles);

}  // namespace svdag
