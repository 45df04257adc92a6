// A bake that is only counted: what the cells of a scene cost at one level of detail.
//
// The plan surveys the whole scene coarsely and a few cells as finely as they will be baked. Both
// go through the descent that bakes, so what saves it work (empty space, the plane memo, repeated
// parts) saves it in the survey, too. Rejected: counting triangles per cell (a wall of two
// triangles is dear, a million of them in one voxel cheap).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "builder/descend/descend.h"
#include "builder/split/triangle_bins.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

// What a descent did.
struct Work {
  double divided = 0;   // cubes
  double computed = 0;  // nodes of the plane memo

  Work& operator+=(const Work& other);
  Work operator-(const Work& other) const;
  Work operator*(double factor) const;
};

struct SurveyConfig {
  int level = 0;       // of detail: voxels of octree level `level` of the grid
  int cell_level = 0;  // of the cells that are counted separately; at most level - 2
  DescentConfig descent;
  uint64_t table_bytes = UINT64_MAX;     // of the unique nodes; beyond, some are counted again
  uint64_t triangle_bytes = UINT64_MAX;  // of a bin; one with more is left out
};

class Survey {
 public:
  using Wanted = std::function<bool(uint64_t cell)>;
  using Visit = std::function<void(uint64_t cell, const Work& work)>;

  Survey(const Grid& grid, const SurveyConfig& config, MemoryBudget* budget);
  ~Survey();

  // Counts the wanted cells of `bin`, in Morton order. False if it has too many triangles.
  bool count(SpillFile* file, const TriangleBin& bin, const Wanted& wanted, const Visit& visit);
  // From now on `part`, a survey of the same kind, also counts those of our cells it `wanted`.
  void share_with(Survey* part, Wanted wanted);
  // Unique nodes and bricks so far.
  uint64_t nodes();
  uint64_t bricks();

 private:
  class Baker;

  Grid fine_;
  Grid grid_;  // `fine_` at the survey's level
  SurveyConfig config_;
  MemoryBudget* budget_;
  std::unique_ptr<Baker> baker_;
  Survey* part_ = nullptr;
  Wanted wanted_by_part_;
};

// `grid` with voxels of octree level `level`; cubes keep their positions.
Grid coarser_grid(const Grid& grid, int level);

}  // namespace svdag
