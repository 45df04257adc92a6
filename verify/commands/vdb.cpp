#include "io/dag/dag_file.h"
#include "io/dag/dag_level.h"
#include "io/dag/open_dag.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "verify/commands/commands.h"
#include "verify/compare/compare_vdb.h"

namespace svdag {
namespace {

void add_voxels(Verdict* verdict, const std::string& key, const char* label, const Grid& grid,
                const std::vector<LatticePoint>& voxels) {
  verdict->for_programs(key, FigureValue::List());
  for (size_t i = 0; i < voxels.size(); ++i)
    verdict->add(key + "/" + std::to_string(i), label, voxel_value(grid, voxels[i]));
}

Verdict verdict_of(const VdbConfig& config, const DagFile& file, const VdbGrid& theirs,
                   const Grid& grid, const IndexMap& map, const VdbComparison& c) {
  Verdict verdict = begin_verdict("vdb", file);
  verdict.for_programs("vdb", config.vdb);
  verdict.add("grid", "grid", theirs.name());
  verdict.also("type", theirs.type());
  verdict.also("level",
               shown(grid.levels, "on level " + std::to_string(grid.levels) + " (" +
                                      format_resolution(uint64_t(grid.resolution())) + "^3)" +
                                      (map.changes_axes() ? ", with other axes" : "")));
  verdict.add("both", "both", c.both, "voxels");
  verdict.add("missing", "missing", c.missing);
  verdict.add("extra", "extra", c.extra);
  add_voxels(&verdict, "first_missing", "  missing", grid, c.first_missing);
  add_voxels(&verdict, "first_extra", "  extra", grid, c.first_extra);
  verdict.add("same", "", shown(c.same(), c.same() ? "same" : "different"));
  return verdict;
}

void write_difference(const VdbConfig& config, const VdbComparison& comparison,
                      VdbComparer* comparer) {
  if (comparison.extra > config.write_most)
    throw Error(ExitCode::kUsage,
                "would get " + std::to_string(comparison.extra) + " voxels, --write-most is " +
                    std::to_string(config.write_most) + ": raise --write-most",
                config.write_diff);
  const std::unique_ptr<VdbWriter> writer = make_vdb_writer();
  comparer->write_difference(writer.get());
  writer->write(config.write_diff, VdbFormat::kBool);
}

}  // namespace

int run(const VdbConfig& config) {
  const Stopwatch stopwatch(config.common);
  if (!config.write_diff.empty()) {
    CommandFiles({config.file, config.vdb}).write(config.write_diff);
    AtomicFile::check(config.write_diff);
  }
  Progress progress(config.common.progress);
  progress.phase("checksums", 0);
  const DagFile file = open_dag(config.file);
  progress.phase("reading the grid", 0);
  const std::unique_ptr<VdbGrid> theirs =
      read_vdb(config.vdb, config.grid, config.iso, config.sandbox);
  reject_needless_range(*theirs, config.iso);
  const GridFit fit = fit_grid(*theirs, file.grid(), config.vdb);
  const Grid grid = level_grid(file.grid(), fit.levels);
  VoxelBox window;  // may extend beyond our grid, where theirs may have voxels
  if (config.bounds) window = voxels_in(grid, *config.bounds);
  if (config.bounds && !window.meets(grid.whole()))
    fail_usage("--bounds: the box contains no voxel of the grid");
  CubeWalk walk(file.view(), uint32_t(fit.levels));
  progress.phase("comparing", 0);
  VdbComparer comparer(*theirs, &walk, fit.map, config.bounds ? &window : nullptr);
  const VdbComparison comparison = comparer.compare(config.show);
  if (!config.write_diff.empty()) write_difference(config, comparison, &comparer);
  progress.finish();
  return finish(config.common, verdict_of(config, file, *theirs, grid, fit.map, comparison),
                comparison.same());
}

}  // namespace svdag
