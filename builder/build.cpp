#include "builder/build.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

#include "builder/voxelize.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Seconds since it was last asked.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

double cpu_seconds() {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// 64 cells along the grid, of at least 64 voxels: enough cells to share out, few enough to be
// cheap.
int choose_cell_level(const BuildConfig& config, const Grid& grid) {
  if (config.cell_level >= 0) return std::min(config.cell_level, grid.levels - 2);
  return std::clamp(grid.levels - 6, 0, 6);
}

void describe_output(const Header& header, BuildReport* report) {
  for (uint32_t k = 0; k < header.section_count; ++k)
    report->nodes.push_back(header.sections[k].nodes);
  report->file_bytes = header.file_bytes;
  char hash[33];
  std::snprintf(hash, sizeof hash, "%016llx%016llx",
                static_cast<unsigned long long>(header.content_hash[1]),
                static_cast<unsigned long long>(header.content_hash[0]));
  report->content_hash = hash;
}

}  // namespace

Grid choose_grid(const BuildConfig& config, const Box& box) {
  const Box& target = config.bounds ? *config.bounds : box;
  const Grid grid = config.voxel_size != 0 ? cover_lattice(target, config.voxel_size)
                                           : divide_box(target, config.levels);
  return config.bounds ? select_bounds(grid, *config.bounds) : grid;
}

BuildReport build(const BuildConfig& config, Executor* executor, Progress* progress) {
  Stopwatch total, phase;
  BuildReport report;
  report.rule = config.descent.rule;
  MemoryBudget budget(config.memory != 0 ? config.memory : default_memory_limit());
  const Scene scene(config.scene, &budget);

  progress->phase("read bounds", 0);
  report.grid = choose_grid(config, config.bounds ? Box() : scene.bounds());
  report.seconds.bounds = phase.lap();

  // The output is opened before the work begins: an unwritable folder is known at once.
  DagWriter writer(config.output, report.grid, report.rule);
  progress->phase("split", 0);
  auto tree =
      std::make_unique<CellTree>(report.grid, choose_cell_level(config, report.grid), &budget);
  report.split = split(scene, tree.get());
  if (report.split.scene.triangles == 0)
    fail_input(config.scene.paths.front(), "the scene has no triangles to bake");
  report.seconds.split = phase.lap();

  VoxelizedCells cells = voxelize(*tree, config.descent, &budget, executor, progress);
  tree.reset();  // the sort needs the room
  report.cells = cells.cells;
  report.voxels = cells.voxels;
  report.decisions = cells.decisions;
  report.memo = cells.memo;
  report.divided = cells.divided;
  report.seconds.voxelize = phase.lap();

  progress->phase("sort", 0);
  std::vector<Run> runs = freeze(&cells, executor);
  report.seconds.sort = phase.lap();

  progress->phase("merge", 0);
  merge(runs, cells.roots, report.grid.levels, &writer, executor);
  report.seconds.merge = phase.lap();
  writer.finish(report.voxels, report.split.largest_snap);
  report.seconds.write = phase.lap();
  progress->finish();

  describe_output(writer.header(), &report);
  report.threads = executor->workers();
  report.seconds.total = total.lap();
  report.seconds.cpu = cpu_seconds();
  report.peak_counted = budget.peak();
  report.peak_resident = peak_resident_bytes();
  return report;
}

}  // namespace svdag
