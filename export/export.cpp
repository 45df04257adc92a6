#include "export/export.h"

#include <cstdio>

#include "export/selection.h"
#include "io/dag/dag_level.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

struct Row {
  ExportFormat format;
  uint64_t (*write)(Selection*, const ExportConfig&, MemoryBudget*);
};

// The one table of formats; a name is also the ending of its files.
constexpr Row kFormats[] = {
    {{"vdb", "OpenVDB, a mask grid (or --bool)"}, export_vdb},
    {{"nvdb", "NanoVDB, a mask grid"}, export_nvdb},
};

const Row& choose(const ExportConfig& config) {
  std::string name = config.format;
  if (name.empty()) {
    const size_t dot = config.output.find_last_of("./");
    if (dot != std::string::npos && config.output[dot] == '.') name = config.output.substr(dot + 1);
  }
  std::string names;
  for (const Row& row : kFormats) {
    if (name == row.format.name) return row;
    names += (names.empty() ? "" : ", ") + std::string(row.format.name);
  }
  if (config.format.empty())
    fail_usage(config.output + ": its ending names no format: choose one with --format: " + names);
  fail_usage("--format: there is no format " + name + ": it must be one of " + names);
}

int checked_level(const DagFile& file, int level) {
  const int finest = int(file.header().levels);
  if (level == 0) return finest;
  if (level < kMinLevels || level > finest)
    fail_usage("--level: " + file.path() + " has levels " + std::to_string(kMinLevels) + " to " +
               std::to_string(finest) + " to export");
  return level;
}

}  // namespace

Selection::Selection(const DagFile& dag_file, const ExportConfig& config)
    : file(dag_file),
      grid(level_grid(dag_file.grid(), checked_level(dag_file, config.level))),
      walk(dag_file.view(), uint32_t(grid.levels)) {
  if (config.bounds) grid = select_bounds(grid, *config.bounds);
}

std::vector<ExportFormat> export_formats() {
  std::vector<ExportFormat> formats;
  for (const Row& row : kFormats) formats.push_back(row.format);
  return formats;
}

int run(const ExportConfig& config) {
  const Row& row = choose(config);
  if (same_file(config.file, config.output))
    fail_usage(config.output + ": is the input; choose another name for the output");
  const DagFile file = DagFile::open(config.file);
  Selection selection(file, config);
  MemoryBudget budget(config.memory ? config.memory : default_memory_limit());
  const uint64_t voxels = row.write(&selection, config, &budget);
  if (!config.quiet)
    std::printf("%s: %s, %s voxels of level %d (%s^3)\n", config.output.c_str(), row.format.name,
                format_count(voxels).c_str(), selection.grid.levels,
                format_resolution(uint64_t(selection.grid.resolution())).c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
