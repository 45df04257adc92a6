// Cost model: predicts seconds, memory and disk from counted work.
//
// CPU seconds are those of voxelizing, which a sample of cells takes on this machine
// (builder/farm/planner/pilot.h), and linear in triangles and nodes found. These constants were
// fitted to bakes of generated scenes (tests/bench/plan.py --calibrate repeats this, and validates
// them on other scenes). The memory of a step is a limit, not an estimate: it stays within it.
// Rejected: fixed seconds for a cube divided and for a node computed for the plane memo (0.6 to 1.6
// of the CPU seconds of hair and boxes, and one machine's speed differs by 1.8 between hours); a
// term for the voxels that triangles decide.
#pragma once

#include "builder/farm/plan/plan.h"

namespace svdag {

// Unique nodes above the bricks, and bricks.
struct NodeCounts {
  double nodes = 0, bricks = 0;

  NodeCounts& operator+=(const NodeCounts& other) {
    nodes += other.nodes;
    bricks += other.bricks;
    return *this;
  }
  double keys() const { return nodes + bricks; }
  double run_bytes() const { return 32 * nodes + 8 * bricks; }
};

// The work of voxelizing `divided` cubes, and `computed` nodes for the plane memo, in cubes.
double descent_work(double divided, double computed);

// Limits of the resources of a step.
struct StepLimits {
  size_t threads = 1;
  uint64_t memory = 0;  // max --memory in bytes; 0: no limit
};

struct ShardWork {
  double cost = 0;            // CPU seconds of voxelizing
  NodeCounts found;           // unique in the shard
  uint64_t triangles = 0;     // in the bins that it reads
  uint64_t heaviest_bin = 0;  // triangles of the heaviest of these bins
};

Prediction predict_shard(const ShardWork& shard, const StepLimits& limits);

// A merge of runs with `read` keys in total to a file with `made` keys; `last`: the file is the
// .svdag.
Prediction predict_merge(const NodeCounts& read, const NodeCounts& made, bool last,
                         const StepLimits& limits);

// The work of a colour pass (builder/farm/planner/colour_survey.h). Only triangles of several
// colours make pairs and cubes.
struct ColourWork {
  int level = 0;            // K
  uint64_t triangles = 0;   // that meet the grid
  uint64_t texels = 0;      // of all images
  uint64_t read_bytes = 0;  // peak memory of reading the scene and decoding the images
  double pairs = 0;         // of a triangle and a cube of the level
  double cubes = 0;         // that get colours
};

// `file`: the bytes of the file without colours.
Prediction predict_colours(const ColourWork& work, uint64_t file, const StepLimits& limits);
// Its peak memory in bytes, where --memory allows `limit`: right within a factor of two.
uint64_t memory_of_colours(const ColourWork& work, uint64_t limit);

// CPU seconds of baking a scene of `triangles` triangles without a plan. `cost`: of voxelizing;
// `spilled`: the triangles do not fit in memory.
double cpu_of_bake(double cost, const NodeCounts& found, uint64_t triangles, bool spilled);
// Its seconds on `threads` threads; one reads the scene.
double seconds_of_bake(double cpu, uint64_t triangles, size_t threads);
// Its peak memory in bytes, where --memory allows `limit`.
uint64_t memory_of_bake(const NodeCounts& found, uint64_t triangles, bool spilled, uint64_t limit);

}  // namespace svdag
