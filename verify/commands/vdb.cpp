#include "verify/commands/vdb.h"
#include "io/pack/unpack.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/dag/dag_file.h"
#include "io/dag/dag_level.h"
#include "io/json_text.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/checksum.h"
#include "verify/compare/compare_vdb.h"

namespace svdag {
namespace {

nlohmann::json list(const std::vector<LatticePoint>& voxels) {
  nlohmann::json json = nlohmann::json::array();
  for (const LatticePoint& v : voxels) json.push_back({v.x, v.y, v.z});
  return json;
}

void print_json(const VdbConfig& config, const DagFile& file, const VdbGrid& theirs,
                const Grid& grid, const VdbComparison& c) {
  const nlohmann::json json = {{"command", "vdb"},
                               {"file", config.file},
                               {"content_hash", to_hex(file.header().content_hash)},
                               {"vdb", config.vdb},
                               {"grid", theirs.name()},
                               {"type", theirs.type()},
                               {"level", grid.levels},
                               {"same", c.same()},
                               {"both", c.both},
                               {"missing", c.missing},
                               {"extra", c.extra},
                               {"first_missing", list(c.first_missing)},
                               {"first_extra", list(c.first_extra)}};
  std::printf("%s\n", json_text(json).c_str());
}

void print_voxels(const char* what, const Grid& grid, const std::vector<LatticePoint>& voxels) {
  for (const LatticePoint& v : voxels) {
    const Point world = voxel_centres(grid)(Point(v));
    std::printf("  %s voxel (%lld, %lld, %lld) at (%.9g, %.9g, %.9g)\n", what,
                static_cast<long long>(v.x), static_cast<long long>(v.y),
                static_cast<long long>(v.z), world.x, world.y, world.z);
  }
}

void print_text(const VdbGrid& theirs, const Grid& grid, const IndexMap& map,
                const VdbComparison& c) {
  std::printf("grid     %s, %s, on level %d (%s^3)%s\n", theirs.name().c_str(),
              theirs.type().c_str(), grid.levels,
              format_resolution(uint64_t(grid.resolution())).c_str(),
              map.changes_axes() ? ", with other axes" : "");
  std::printf("both     %s voxels\nmissing  %s\nextra    %s\n", format_count(c.both).c_str(),
              format_count(c.missing).c_str(), format_count(c.extra).c_str());
  print_voxels("missing", grid, c.first_missing);
  print_voxels("extra  ", grid, c.first_extra);
  std::printf(c.same() ? "same\n" : "different\n");
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
  if (same_file(config.write_diff, config.file) || same_file(config.write_diff, config.vdb))
    fail_usage(config.write_diff + ": is an input; choose another name for the difference");
  if (!config.write_diff.empty()) AtomicFile::check(config.write_diff);
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
  if (config.common.json) {
    print_json(config, file, *theirs, grid, comparison);
  } else if (!config.common.quiet) {
    print_text(*theirs, grid, fit.map, comparison);
  }
  return int(comparison.same() ? ExitCode::kOk : ExitCode::kDiffers);
}

}  // namespace svdag
