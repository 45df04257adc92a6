// Sampled bricks: an answer about a large file in a bounded time and memory.
//
// Half of the bricks are drawn uniformly from the DAG's occupied bricks (they would show extra
// voxels and missing neighbours), half from the scene (scene_draw.h; they would show bricks that
// are missing altogether, which no draw from the file can). Then the scene is streamed once more
// against the sampled bricks alone: a sorted list of Morton codes is an octree already, in which a
// triangle descends as long as it touches the cell, exactly.
// What a sample says about the whole is said of each kind of draw by itself: "all bricks", those
// of the file and those it lacks, is nothing that one can draw from uniformly.
// Rejected: holding the scene (it may not fit), testing every triangle against every brick.
#pragma once

#include <cstdint>
#include <vector>

#include "io/brick.h"
#include "io/dag/dag_view.h"
#include "verify/judge/cell_code.h"
#include "verify/judge/judge.h"
#include "verify/sample/compare.h"
#include "verify/sample/scene_draw.h"

namespace svdag {

// The Morton codes of `count` bricks of the DAG, each occupied brick of the grid equally likely.
std::vector<uint64_t> sample_dag(const DagView& dag, uint64_t count, Random& random);

// Of `count` draws, half from either side; the odd one is the scene's, so that one draw sees a file
// that lacks everything. What the scene cannot give is drawn from the file.
struct BrickDraw {
  std::vector<uint64_t> file;
  SceneDraw scene;

  std::vector<uint64_t> all() const;
  // There is nothing to compare: the file has no voxel, and no triangle's box meets the selection.
  bool both_empty() const { return all().empty() && scene.near == 0; }
  // There may be something, but nothing was drawn: no judgement follows.
  bool untested() const { return all().empty() && scene.near > 0; }
};
BrickDraw draw_bricks(const Scene& scene, const DagView& dag, const Grid& grid, uint64_t count,
                      uint64_t seed);

// What a draw takes while its brick is drawn and compared: its place, its code some times over, and
// the brick; or its window.
constexpr uint64_t kBytesOfDraw = 64;

// The Error (kUsage) of an untested sample.
[[noreturn]] void fail_untested();

// Voxelizes exactly the given bricks (sorted, without repetition) while triangles go by.
class BrickSample {
 public:
  BrickSample(const Grid& grid, std::vector<uint64_t> codes);

  // Adds what a triangle sets; calls may run at once if each has its own judge.
  void add(const LatticeTriangle& triangle, Judge& judge);
  Comparison compare(const DagView& dag) const;
  // How many of these draws gave a wrong brick; all of them must be in the sample.
  uint64_t count_wrong(const DagView& dag, const std::vector<uint64_t>& draws) const;

 private:
  Brick in_file(const DagView& dag, size_t index) const;
  void descend(const LatticeTriangle& triangle, Judge& judge, uint64_t cell, int height,
               size_t begin, size_t end);
  void fill(const LatticeTriangle& triangle, Judge& judge, size_t index);

  Grid grid_;
  std::vector<uint64_t> codes_;
  std::vector<Brick> bricks_;  // what the triangles set so far, by index into codes_
};

// Draws of one kind, repetitions counted, and how many gave a wrong brick.
struct DrawnBricks {
  uint64_t draws = 0;
  uint64_t wrong = 0;
};

struct SampleComparison {
  Comparison comparison;  // of all that were drawn, each brick once
  DrawnBricks file;       // of the file's occupied bricks, each equally likely
  std::array<DrawnBricks, kMeasures> scene;
  bool both_empty = false, untested = false;  // as in BrickDraw
};

// The whole: `count` bricks drawn with `seed`, judged on all workers.
SampleComparison compare_sample(const Scene& scene, const DagView& dag, const Grid& grid,
                                uint64_t count, uint64_t seed, const JudgeChoice& choice,
                                Executor& executor, Progress& progress);

}  // namespace svdag
