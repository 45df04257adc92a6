// A survey counts the work of baking the cells of a scene at one level of detail.
//
// The planner surveys the whole scene coarsely, and a few cells at the level of the bake. Both use
// the descent of the bake, so whatever saves work there (empty space, the plane memo, repeated
// parts) also saves it in the survey. Rejected: counting triangles per cell (a wall of two
// triangles is expensive, a million triangles in one voxel are cheap).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "builder/descend/descend.h"
#include "builder/split/triangle_bins.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

// Counted work of a descent.
struct Work {
  double divided = 0;   // cubes divided
  double computed = 0;  // nodes computed for the plane memo

  Work& operator+=(const Work& other);
  Work operator-(const Work& other) const;
  Work operator*(double factor) const;
};

struct SurveyConfig {
  int level = 0;       // voxels of the survey are cubes of this octree level of the grid
  int cell_level = 0;  // of the cells that are counted separately; at most level - 2
  DescentConfig descent;
  uint64_t table_bytes = UINT64_MAX;     // node table; when full, nodes may be counted repeatedly
  uint64_t triangle_bytes = UINT64_MAX;  // bins with more bytes of triangles are skipped
};

class Survey {
 public:
  using CellFilter = std::function<bool(uint64_t cell)>;
  using Visit = std::function<void(uint64_t cell, const Work& work)>;

  Survey(const Grid& grid, const SurveyConfig& config, MemoryBudget* budget);
  ~Survey();

  // Counts the cells of `bin` that pass `filter` (an empty filter passes all), in Morton order.
  // Returns false if the bin has too many triangles.
  bool count(SpillFile* file, const TriangleBin& bin, const CellFilter& filter, const Visit& visit);
  // Later calls of count() also count the cells that pass `in_subset` in `subset`, a survey with
  // the same grid and config.
  void add_subset(Survey* subset, CellFilter in_subset);
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
  Survey* subset_ = nullptr;
  CellFilter in_subset_;
};

// `grid` with voxels of octree level `level`; cubes keep their positions.
Grid coarser_grid(const Grid& grid, int level);

}  // namespace svdag
