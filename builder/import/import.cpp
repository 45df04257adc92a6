#include "builder/import/import.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>

#include "builder/import/full_cubes.h"
#include "builder/import/graph_reduction.h"
#include "builder/merge/merge.h"
#include "builder/octree/morton.h"
#include "builder/reduce/brick_reduction.h"
#include "builder/run/bake_output.h"
#include "builder/workspace/disk_need.h"
#include "builder/workspace/workspace.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/sort/external_sort.h"

namespace svdag {
namespace {

// A voxel is sorted by its Morton code: the brick's code, then the bit in the brick (low 6 bits).
struct CodeWord {
  uint32_t operator()(uint64_t code, size_t i) const { return uint32_t(code >> (i == 0 ? 32 : 0)); }
};
using VoxelSort = ExternalSort<uint64_t, CodeWord>;

// Reduces sorted voxels, as bricks, and the full cubes between them.
class VoxelReduction {
 public:
  VoxelReduction(int levels, const FullCubes& cubes, SubDagBuilder* builder)
      : levels_(levels), cubes_(cubes), bricks_(builder) {}

  void run(VoxelSort* sort) {
    sort->finish([this](const auto& codes) {
      for (const uint64_t voxel : codes) add(voxel);
    });
    add_cubes(UINT64_MAX);
    add_brick();
    bricks_.finish();
  }

 private:
  void add(uint64_t voxel) {
    add_cubes(voxel);
    if (voxel < covered_) return;
    if (voxel >> 6 != code_) {
      add_brick();
      code_ = voxel >> 6;
    }
    brick_ |= Brick(1) << (voxel & 63);
  }

  void add_brick() {
    if (brick_ != 0) bricks_.add(code_, brick_);
    brick_ = 0;
  }

  // Adds the full cubes that begin at or before voxel `last`.
  void add_cubes(uint64_t last) {
    for (; next_ < cubes_.size() && cubes_[next_].begin <= last; ++next_) {
      const FullCubes::Range cube = cubes_[next_];
      add_brick();
      bricks_.add_full(cube.begin >> 3 * cube.log2_side, levels_ - cube.log2_side);
      covered_ = cube.end();
    }
  }

  const int levels_;
  const FullCubes& cubes_;
  BrickReduction bricks_;
  size_t next_ = 0;       // index in cubes_
  uint64_t covered_ = 0;  // end of the last full cube
  uint64_t code_ = 0;     // of the brick being collected
  Brick brick_ = 0;
};

class Import {
 public:
  Import(const ImportConfig& config, Executor* executor)
      : config_(config),
        executor_(executor),
        workspace_(ScratchDir::path_for(config.output, config.scratch), config.memory,
                   executor->workers()) {
    workspace_.clear(config.output,
                     "finish or discard it first with svdag build, or choose another output");
  }

  ImportReport run(NodeGraph* graph) {
    Grid grid = graph->grid();
    if (config_.levels != 0 && config_.levels != grid.levels)
      fail_usage("-r: the file has a fixed resolution of " +
                 format_resolution(uint64_t(grid.resolution())) + ": omit -r");
    DagOutput output(config_.output, grid, config_.rule, config_.layout, workspace_.room());
    const ReductionConfig reduction{workspace_.budget(), workspace_.shares().sort, executor_,
                                    [this] { return new_file(); }};
    const uint64_t voxels = reduce_graph(graph, reduction, &output);
    finish(&output, {}, voxels);
    return describe(grid, output);
  }

  ImportReport run(const VoxelSource& source, uint64_t count) {
    MemoryBudget* const budget = workspace_.budget();
    Scratch* const scratch = workspace_.scratch();
    std::optional<VoxelSort> sort;
    sort.emplace(sort_room(), 2, CodeWord());
    DiskNeed(scratch).expect_records(count * sizeof(uint64_t), sort_room().bytes / 2, "voxels");
    FullCubes cubes(budget);
    uint32_t highest = 0;  // bitwise or of all coordinates
    const GridPlacement place = source(
        [&](std::span<const Voxel> voxels) {
          check_interrupt();
          for (const auto& [x, y, z] : voxels) {
            highest |= x | y | z;
            sort->push(morton(LatticePoint(x, y, z)));
          }
        },
        [&](const FullCube& cube) {
          const auto& [x, y, z] = cube.origin;
          highest |= x | y | z | ((uint32_t(1) << cube.log2_side) - 1);
          cubes.add(cube);
        });
    cubes.sort();
    const Grid grid = choose_grid(place, highest);
    DagOutput output(config_.output, grid, config_.rule, config_.layout, workspace_.room());
    RunSet set = reduce(grid.levels, cubes, &*sort);
    sort.reset();  // the merge needs the memory
    const MergeConfig merging = share_for_merge(budget, set.spilled ? scratch : nullptr,
                                                executor_->workers(), 4 * scratch->block_bytes());
    const auto roots = merge(set.runs, std::move(set.roots), GridPart::whole(grid.levels), merging,
                             &output, executor_);
    finish(&output, roots, set.voxels);
    return describe(grid, output);
  }

 private:
  File new_file() { return workspace_.folder()->create("sort" + std::to_string(files_++)); }

  RunSet reduce(int levels, const FullCubes& cubes, VoxelSort* sort) {
    RunSet set;
    std::unique_ptr<SubDagBuilder> builder;
    const auto take_run = [&](bool spill) {
      const SpillTarget target = new_target(workspace_.scratch(), levels);
      set.add(builder->take_run(spill ? &target : nullptr));
    };
    builder = std::make_unique<SubDagBuilder>(
        levels, SubDagBuilderConfig{.budget = workspace_.budget(),
                                    .table_bytes = workspace_.shares().brick_table,
                                    .empty_table = [&] { take_run(true); }});
    VoxelReduction(levels, cubes, builder.get()).run(sort);
    take_run(set.spilled);
    return set;
  }

  ExternalSortConfig sort_room() {
    const uint64_t min = 2 * executor_->workers() * ExternalSortConfig::kMinBytesPerWorker;
    return {workspace_.budget(), std::max(workspace_.shares().sort, min), executor_,
            [this] { return new_file(); }};
  }

  Grid choose_grid(const GridPlacement& place, uint32_t highest) const {
    const uint64_t needed = std::max<uint64_t>(uint64_t(highest) + 1, place.resolution);
    Grid grid;
    grid.levels = config_.levels != 0 ? config_.levels
                                      : std::max(kMinLevels, int(std::bit_width(needed - 1)));
    if (grid.levels > kMaxLevels || uint64_t(highest) >> grid.levels != 0)
      fail_usage("-r: the voxels need a resolution of at least " +
                 format_count(uint64_t(highest) + 1));
    grid.origin = place.corner;
    grid.voxel_size = place.voxel_size;
    bool valid = std::isnormal(grid.voxel_size) && grid.voxel_size > 0;
    for (int a = 0; a < 3; ++a) valid = valid && std::isfinite(grid.origin[a]);
    if (!valid) fail_input(config_.source, "invalid origin or voxel size of the grid");
    grid.selection = grid.whole();
    return grid;
  }

  void finish(DagOutput* output, std::span<const SubDagRoot> roots, uint64_t voxels) const {
    if (config_.inputs != nullptr) config_.inputs->check();
    output->finish(roots, voxels, config_.largest_snap, {});
  }

  ImportReport describe(const Grid& grid, const DagOutput& output) const {
    ImportReport report;
    report.grid = grid;
    report.voxels = output.voxels();
    for (const uint64_t nodes : output.key_counts()) report.nodes += nodes;
    report.file_bytes = output.file_bytes();
    report.content_hash = output.content_hash();
    report.spilled = files_;
    return report;
  }

  const ImportConfig& config_;
  Executor* executor_;
  Workspace workspace_;
  int files_ = 0;
};

}  // namespace

ImportReport import_graph(NodeGraph* graph, const ImportConfig& config, Executor* executor) {
  return Import(config, executor).run(graph);
}

ImportReport import_voxels(const VoxelSource& source, const ImportConfig& config,
                           Executor* executor, uint64_t count) {
  return Import(config, executor).run(source, count);
}

}  // namespace svdag
