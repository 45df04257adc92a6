#include "verify/commands/common.h"

#include <array>
#include <cstdio>

#include "io/dag/dag_file.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

Stopwatch::~Stopwatch() {
  if (!enabled_) return;
  std::fprintf(stderr, "%.2f s, peak memory %s\n", timer_.lap(),
               format_bytes(peak_resident_bytes()).c_str());
}

Verdict begin_verdict(const char* command, const DagFile& file) {
  Verdict verdict;
  verdict.for_programs("command", command);
  verdict.for_programs("file", file.path());
  verdict.for_programs("content_hash", to_hex(file.header().content_hash));
  return verdict;
}

int finish(const CommonConfig& config, const Verdict& verdict, bool ok) {
  if (config.json) {
    std::puts(verdict.json().c_str());
  } else if (!config.quiet) {
    std::fputs(verdict.text().c_str(), stdout);
  }
  return int(ok ? ExitCode::kOk : ExitCode::kDiffers);
}

FigureValue voxel_value(const Grid& grid, const LatticePoint& voxel) {
  return shown(std::array{voxel.x, voxel.y, voxel.z},
               "voxel (" + std::to_string(voxel.x) + ", " + std::to_string(voxel.y) + ", " +
                   std::to_string(voxel.z) + ") at " +
                   format_point(grid.corner() + (Point(voxel) + 0.5) * grid.voxel_size));
}

void add_agreeing_layers(Verdict* verdict, int64_t count) {
  if (count == 0) return;
  verdict->for_people("layers",
                      format_count(uint64_t(count), "layer") + (count == 1 ? " agrees" : " agree"));
}

std::string describe_grid(const DagFile& file) {
  const Grid grid = file.grid();
  const Point corner = grid.corner();
  std::string text = format_resolution(uint64_t(grid.resolution())) + "^3 " + kind_name(grid.kind) +
                     ", voxel size " + format_double(grid.voxel_size) + ", corner (" +
                     format_double(corner.x) + ", " + format_double(corner.y) + ", " +
                     format_double(corner.z) + "), rule " + rule_name(file.rule());
  if (!grid.bounded) return text;
  const auto& [min, max] = grid.selection;
  for (int a = 0; a < 3; ++a)
    text += (a == 0 ? ", bounded to voxels [" : " x [") + std::to_string(min[a]) + ", " +
            std::to_string(max[a]) + ")";
  return text;
}

}  // namespace svdag
