#include "builder/import.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "builder/bake_output.h"
#include "builder/brick_reduction.h"
#include "builder/cell.h"
#include "builder/checkpoint.h"
#include "builder/disk_need.h"
#include "builder/graph_reduction.h"
#include "builder/merge.h"
#include "io/units.h"
#include "streaming/checksum.h"
#include "streaming/error.h"
#include "streaming/external_sort.h"

namespace svdag {
namespace {

// A voxel by the Morton code of its place: its brick above, its bit in the brick in the low 6 bits.
struct CodeWord {
  uint32_t operator()(uint64_t code, size_t i) const { return uint32_t(code >> (i == 0 ? 32 : 0)); }
};
using VoxelSort = ExternalSort<uint64_t, CodeWord>;

class Import {
 public:
  Import(const ImportConfig& config, Executor* executor)
      : config_(config),
        executor_(executor),
        budget_(config.memory != 0 ? config.memory : default_memory_limit()),
        folder_(ScratchDir::path_for(config.output, config.scratch)) {
    if (Checkpoint::exists(folder_)) {
      folder_.keep();
      fail_usage(config.output + ": an unfinished bake of it is in " + folder_.path() +
                 ": finish or discard it first with svdag build, or choose another output");
    }
    folder_.clear();  // of what a killed import left
  }

  ImportReport run(NodeGraph* graph) {
    Grid grid = graph->grid();
    if (config_.levels != 0 && config_.levels != grid.levels)
      fail_usage("-r: the resolution of this file is " +
                 format_resolution(uint64_t(grid.resolution())));
    DagOutput output(config_.output, grid, Rule::kConservative);
    const ReductionRoom room{&budget_, executor_, [this] { return new_file(); }};
    output.finish({}, reduce_graph(graph, room, &output), 0);
    return describe(grid, output);
  }

  ImportReport run(const VoxelSource& source, uint64_t count) {
    Scratch scratch(&folder_, &budget_);
    std::optional<VoxelSort> sort;
    sort.emplace(sort_room(), 2, CodeWord());
    DiskNeed(&scratch).expect_records(count * sizeof(uint64_t), sort_room().bytes / 2, "voxels");
    uint32_t highest = 0;  // all coordinates, one over the other
    const VoxelPlace place = source([&](std::span<const Voxel> voxels) {
      check_interrupt();
      for (const auto& [x, y, z] : voxels) {
        highest |= x | y | z;
        sort->push(morton(LatticePoint(x, y, z)));
      }
    });
    const Grid grid = choose_grid(place, highest);
    DagOutput output(config_.output, grid, Rule::kConservative);
    BrickReduction bricks(grid.levels, {&budget_, &scratch, budget_.limit() / 4});
    const uint64_t voxels = reduce(&*sort, &bricks);
    sort.reset();  // the merge needs the room
    MergeConfig merging;
    merging.budget = &budget_;
    merging.scratch = bricks.spilled() ? &scratch : nullptr;
    merging.map_bytes = budget_.limit() / 2;
    merging.sources = std::max<size_t>(2, budget_.limit() * 3 / 8 / (4 * scratch.block_bytes()));
    const auto roots = merge(bricks.runs(), std::move(bricks.roots()), Part::whole(grid.levels),
                             merging, &output, executor_);
    output.finish(roots, voxels, 0);
    return describe(grid, output);
  }

 private:
  File new_file() { return folder_.create("sort" + std::to_string(files_++)); }

  ExternalSortRoom sort_room() {
    const uint64_t least = 2 * executor_->workers() * ExternalSortRoom::kLeast;
    return {&budget_, std::max(budget_.limit() / 4, least), executor_,
            [this] { return new_file(); }};
  }

  // The bricks of the sorted voxels; returns how many voxels there are without repetitions.
  static uint64_t reduce(VoxelSort* sort, BrickReduction* bricks) {
    uint64_t code = 0, voxels = 0;
    Brick brick = 0;
    const auto add = [&] {
      if (brick == 0) return;
      voxels += uint64_t(std::popcount(brick));
      bricks->add(code, brick);
    };
    sort->finish([&](const auto& codes) {
      for (const uint64_t voxel : codes) {
        if (voxel >> 6 != code) {
          add();
          code = voxel >> 6;
          brick = 0;
        }
        brick |= Brick(1) << (voxel & 63);
      }
    });
    add();
    bricks->finish();
    return voxels;
  }

  Grid choose_grid(const VoxelPlace& place, uint32_t highest) const {
    const uint64_t needed = std::max<uint64_t>(uint64_t(highest) + 1, place.resolution);
    Grid grid;
    grid.levels = config_.levels != 0 ? config_.levels
                                      : std::max(kMinLevels, int(std::bit_width(needed - 1)));
    if (grid.levels > kMaxLevels || uint64_t(highest) >> grid.levels != 0)
      fail_usage("-r: the voxels need a grid of " + format_count(uint64_t(highest) + 1) +
                 " at least");
    grid.origin = place.corner;
    grid.voxel_size = place.voxel_size;
    bool good = std::isnormal(grid.voxel_size) && grid.voxel_size > 0;
    for (int a = 0; a < 3; ++a) good = good && std::isfinite(grid.origin[a]);
    if (!good) throw Error(ExitCode::kBadInput, "the file puts its voxels at an impossible place");
    grid.selection = grid.whole();
    return grid;
  }

  static ImportReport describe(const Grid& grid, const DagOutput& output) {
    ImportReport report;
    report.grid = grid;
    report.voxels = output.voxels();
    for (const uint64_t nodes : output.keys()) report.nodes += nodes;
    report.file_bytes = output.file_bytes();
    report.content_hash = output.content_hash();
    return report;
  }

  const ImportConfig& config_;
  Executor* executor_;
  MemoryBudget budget_;
  ScratchDir folder_;
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
