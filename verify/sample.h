// Sampled bricks: an answer about a large file in a bounded time and memory.
//
// Half of the bricks are drawn uniformly from the DAG's occupied bricks (they would show extra
// voxels and missing neighbours), half along the triangles, half of those by area and half by
// count, moved by up to a voxel (they would show missing bricks). Then the scene is streamed once
// more against the sampled bricks alone: a sorted list of Morton codes is an octree already, in
// which a triangle descends as long as it touches the cell, exactly.
// Rejected: holding the scene (it may not fit), testing every triangle against every brick.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "io/brick.h"
#include "io/dag/dag_view.h"
#include "verify/cell_code.h"
#include "verify/compare.h"
#include "verify/judge.h"
#include "verify/snapped_scene.h"

namespace svdag {

// The same numbers from every standard library: std::uniform_* leave the algorithm open.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  // Uniform in 0 .. n-1.
  uint64_t below(uint64_t n) { return uint64_t(UInt128(engine_()) * n >> 64); }
  // Uniform in [0, 1).
  double unit() { return double(engine_() >> 11) * 0x1p-53; }

 private:
  __extension__ typedef unsigned __int128 UInt128;
  std::mt19937_64 engine_;
};

// The Morton codes of `count` bricks of the DAG, each occupied brick of the grid equally likely.
std::vector<uint64_t> sample_dag(const DagView& dag, uint64_t count, Random& random);

// The Morton codes of up to `count` bricks along the triangles; streams the scene twice.
std::vector<uint64_t> sample_scene(const Scene& scene, const Grid& grid, uint64_t count,
                                   Random& random);

// Voxelizes exactly the given bricks (sorted, without repetition) while triangles go by.
class BrickSample {
 public:
  BrickSample(const Grid& grid, std::vector<uint64_t> codes);

  // Adds what a triangle sets; calls may run at once if each has its own judge.
  void add(const LatticeTriangle& triangle, Judge& judge);
  Comparison compare(const DagView& dag) const;

 private:
  void descend(const LatticeTriangle& triangle, Judge& judge, uint64_t cell, int height,
               size_t begin, size_t end);
  void fill(const LatticeTriangle& triangle, Judge& judge, size_t index);

  Grid grid_;
  std::vector<uint64_t> codes_;
  std::vector<Brick> bricks_;  // what the triangles set so far, by index into codes_
};

// The whole: `count` bricks drawn with `seed`, judged on all workers.
Comparison compare_sample(const Scene& scene, const DagView& dag, const Grid& grid, uint64_t count,
                          uint64_t seed, const JudgeChoice& choice, Executor& executor,
                          Progress& progress);

}  // namespace svdag
