#include "verify/commands/common.h"

#include <cstdio>

#include "io/dag/dag_file.h"
#include "io/units.h"
#include "streaming/memory_budget.h"

namespace svdag {

Stopwatch::Stopwatch(const CommonConfig& config)
    : enabled_(config.verbose), start_(std::chrono::steady_clock::now()) {}

Stopwatch::~Stopwatch() {
  if (!enabled_) return;
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start_;
  std::fprintf(stderr, "%.2f s, peak memory %s\n", seconds.count(),
               format_bytes(peak_resident_bytes()).c_str());
}

std::string describe_grid(const DagFile& file) {
  const Grid grid = file.grid();
  const Point corner = grid.corner();
  std::string text = format_resolution(uint64_t(grid.resolution())) + "^3 " +
                     (grid.kind == Grid::Kind::kBox ? "box" : "lattice") + ", voxel size " +
                     format_double(grid.voxel_size) + ", corner (" + format_double(corner.x) +
                     ", " + format_double(corner.y) + ", " + format_double(corner.z) + "), rule " +
                     (file.rule() == Rule::kThin ? "thin" : "conservative");
  if (grid.bounded) text += ", bounded";
  return text;
}

void print_wrong_voxel(const Grid& grid, const LatticePoint& v, bool missing) {
  const Point corner = grid.corner();
  const auto world = [&](int a) { return corner[a] + (double(v[a]) + 0.5) * grid.voxel_size; };
  std::printf("  %s voxel (%lld, %lld, %lld) at (%.9g, %.9g, %.9g)\n",
              missing ? "missing" : "extra  ", static_cast<long long>(v.x),
              static_cast<long long>(v.y), static_cast<long long>(v.z), world(0), world(1),
              world(2));
}

}  // namespace svdag
