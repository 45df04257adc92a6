// Sets of bricks, and the DAG files that builder/reduce/brick_reduction.h makes of them.
#pragma once

#include <map>
#include <memory>
#include <random>

#include "builder/merge/merge.h"
#include "builder/octree/morton.h"
#include "builder/reduce/brick_reduction.h"
#include "io/dag/dag_file.h"
#include "tests/reference_reduction.h"
#include "tests/temp_folder.h"

namespace svdag {

inline Grid unit_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.selection = grid.whole();
  return grid;
}

// Bricks of few kinds in clumps, so that nodes of all levels repeat.
inline BrickMap random_bricks(int levels, size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  const uint32_t side = 1U << (levels - 2);
  BrickMap bricks;
  for (size_t i = 0; i < count; ++i) {
    const auto below = [&](uint32_t n) { return uint32_t(random() % n); };
    const Coordinate at{below(side), below(side), below(4)};
    bricks[at] = uint64_t(1 + random() % 3) << (random() % 60);
  }
  return bricks;
}

inline std::vector<std::pair<uint64_t, Brick>> in_morton_order(const BrickMap& bricks) {
  std::map<uint64_t, Brick> sorted;
  for (const auto& [at, brick] : bricks) sorted[morton({at[0], at[1], at[2]})] = brick;
  return {sorted.begin(), sorted.end()};
}

// The DAG file of what fill(reduction) adds; the table is spilled whenever it has `table_bytes`.
template <class Fill>
std::string reduce(int levels, uint64_t table_bytes, size_t* runs, const Fill& fill) {
  const TempFolder folder;
  MemoryBudget budget;
  ScratchDir scratch_dir(folder.file("scratch"));
  Scratch scratch(&scratch_dir, &budget);
  RunSet set;
  std::unique_ptr<SubDagBuilder> builder;
  const auto take_run = [&](bool spill) {
    const SpillTarget target = new_target(&scratch, levels);
    set.add(builder->take_run(spill ? &target : nullptr));
  };
  builder = std::make_unique<SubDagBuilder>(
      levels,
      SubDagBuilderConfig{
          .budget = &budget, .table_bytes = table_bytes, .empty_table = [&] { take_run(true); }});
  BrickReduction reduction(builder.get());
  fill(&reduction);
  reduction.finish();
  take_run(set.spilled);
  *runs = set.runs.size();
  DagOutput output(folder.file("a.svdag"), unit_grid(levels), Rule::kConservative);
  MergeConfig config;
  config.budget = &budget;
  config.scratch = set.spilled ? &scratch : nullptr;
  config.map_bytes = uint64_t(1) << 20;
  config.max_sources = 4;
  SequentialExecutor executor;
  output.finish(merge(set.runs, set.roots, GridPart::whole(levels), config, &output, &executor),
                set.voxels, 0, {});
  return folder.read("a.svdag");
}

inline std::string reduce_bricks(const BrickMap& bricks, int levels, uint64_t table_bytes,
                                 size_t* runs) {
  return reduce(levels, table_bytes, runs, [&](BrickReduction* reduction) {
    for (const auto& [code, brick] : in_morton_order(bricks)) reduction->add(code, brick);
  });
}

inline std::vector<uint64_t> node_counts(const DagFile& file) {
  std::vector<uint64_t> counts;
  for (uint32_t k = 0; k < file.header().section_count; ++k)
    counts.push_back(file.header().sections[k].nodes);
  return counts;
}

}  // namespace svdag
