// Compares a random sample of bricks: judges a large file in bounded time and memory.
//
// Half of the bricks are drawn uniformly from the DAG's occupied bricks (these show extra voxels
// and missing neighbours), half from the scene (scene_draw.h; these show bricks that are missing
// altogether, which no draw from the file can). The scene is then streamed again and tested against
// the sampled bricks only: their sorted list of Morton codes is an octree, in which each triangle
// descends as long as it touches the cell, exactly.
// Statistical statements are made per kind of draw: the union of the bricks that the file has and
// those that it lacks cannot be sampled uniformly.
// Rejected: holding the scene in memory (it may not fit), testing every triangle against every
// brick.
#pragma once

#include <cstdint>
#include <vector>

#include "io/brick.h"
#include "io/dag/dag_view.h"
#include "verify/judge/judge.h"
#include "verify/judge/judge_cells.h"
#include "verify/sample/compare.h"
#include "verify/sample/scene_draw.h"

namespace svdag {

// Draws the Morton codes of `count` bricks, each occupied brick of the grid equally likely.
std::vector<uint64_t> sample_dag(const DagView& dag, uint64_t count, Random& random);

// `count` draws, half from the file and half from the scene. An odd draw is the scene's, so that a
// single draw detects an empty file. Draws that the scene cannot give are made from the file. For
// the solid rules, the same number is drawn again anywhere in the selection, inside and outside.
struct BrickDraw {
  std::vector<uint64_t> file;
  SceneDraw scene;
  std::vector<uint64_t> anywhere;

  std::vector<uint64_t> all() const;
  // Nothing to compare: the file has no voxel, and no triangle's box meets the selection.
  bool both_empty() const { return all().empty() && scene.near == 0; }
  // Nothing was drawn although the scene may set voxels: no conclusion is possible.
  bool untested() const { return all().empty() && scene.near > 0; }
};
BrickDraw draw_bricks(const Scene& scene, const DagView& dag, const Grid& grid, Rule rule,
                      uint64_t count, uint64_t seed);

// Memory of one draw while its brick is drawn and compared: its position, several copies of its
// code, and the brick; or its window.
constexpr uint64_t kBytesOfDraw = 64;
// With a solid rule, for which the same number of bricks is drawn again: also the voxels' windings.
constexpr uint64_t kBytesOfSolidDraw = 2 * (kBytesOfDraw + 64 * sizeof(int32_t));

// Throws the Error (kUsage) for an untested sample.
[[noreturn]] void fail_untested();

// Voxelizes exactly the given bricks (sorted and unique) from a stream of triangles.
class BrickSample {
 public:
  BrickSample(const Grid& grid, std::vector<uint64_t> codes);

  // Adds the voxels that a triangle sets. Calls may run concurrently if each has its own judge.
  void add(const LatticeTriangle& triangle, Judge& judge);
  // Sets further voxels, of brick `index`.
  void set(size_t index, Brick voxels) { bricks_[index] |= voxels; }
  const std::vector<uint64_t>& codes() const { return codes_; }
  Comparison compare(const DagView& dag) const;
  // The number of these draws that gave a wrong brick. All must be in the sample.
  uint64_t count_wrong(const DagView& dag, const std::vector<uint64_t>& draws) const;

 private:
  Brick in_file(const DagView& dag, size_t index) const;
  void descend(const LatticeTriangle& triangle, Judge& judge, uint64_t cell, int height,
               size_t begin, size_t end);
  void fill(const LatticeTriangle& triangle, Judge& judge, size_t index);

  Grid grid_;
  std::vector<uint64_t> codes_;
  std::vector<Brick> bricks_;  // voxels set so far, by index into codes_
};

// Number of draws of one kind, with repetitions, and of those that gave a wrong brick.
struct DrawnBricks {
  uint64_t draws = 0;
  uint64_t wrong = 0;
};

struct SampleComparison {
  Comparison comparison;  // of all drawn bricks, each counted once
  DrawnBricks file;       // drawn from the file's occupied bricks
  std::array<DrawnBricks, kMeasures> scene;
  DrawnBricks anywhere;                       // solid rules only
  bool both_empty = false, untested = false;  // as in BrickDraw
};

// Draws `count` bricks with `seed` and judges them on all workers.
SampleComparison compare_sample(const Scene& scene, const DagView& dag, const Grid& grid,
                                uint64_t count, uint64_t seed, const JudgeChoice& choice,
                                Executor& executor, Progress& progress);

}  // namespace svdag
