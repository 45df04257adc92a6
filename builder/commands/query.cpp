// `svdag query FILE.svdag < POINTS`: which points are in a set voxel, and its colour.
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "builder/commands/commands.h"
#include "io/dag/colours/dag_colours.h"
#include "io/dag/cube_at.h"
#include "io/dag/dag_file.h"
#include "io/dag/occupied_bounds.h"
#include "io/dag/open_dag.h"
#include "io/lattice.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/system_call.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr const char* kInput = "standard input";
constexpr size_t kMaxLine = 65536;  // bytes

// The next line of standard input, without its end. False at the end of the input.
bool read_line(uint64_t number, std::string* line) {
  line->clear();
  int c;
  while ((c = getc_unlocked(stdin)) != EOF && c != '\n') {
    if (line->size() == kMaxLine)
      fail_input(kInput, "line " + std::to_string(number) + " is longer than " +
                             std::to_string(kMaxLine) + " bytes");
    *line += char(c);
  }
  if (std::ferror(stdin)) fail_call(ExitCode::kBadInput, "cannot be read", kInput, errno);
  return c != EOF || !line->empty();
}

// "1 2.5 3" or "1,2.5,3", also with more text after a further separator.
Point parse_point(const std::string& line, uint64_t number) {
  Point p;
  const char *at = line.data(), *end = at + line.size();
  const auto is_separator = [](char c) { return c == ' ' || c == ',' || c == '\t' || c == '\r'; };
  for (int a = 0; a < 3; ++a) {
    while (at != end && is_separator(*at)) ++at;
    const auto [stop, error] = std::from_chars(at, end, p[a]);
    if (error != std::errc() || (stop != end && !is_separator(*stop)) || !std::isfinite(p[a]))
      fail_input(kInput, "line " + std::to_string(number) + " is not a point: give x y z");
    at = stop;
  }
  return p;
}

// The voxel of a point by the rounding of a bake, if it is in the grid; a point on a plane between
// two voxels is in the upper one.
std::optional<LatticePoint> voxel_of(const Lattice& lattice, const Grid& grid, const Point& p) {
  const double reach = 2 * double(grid.resolution()) * grid.voxel_size;
  LatticePoint voxel;
  for (int a = 0; a < 3; ++a) {
    if (!(std::abs(p[a] - grid.corner()[a]) < reach))
      return std::nullopt;  // may be too far to snap
  }
  const LatticePoint q = lattice.snap(p);
  for (int a = 0; a < 3; ++a) voxel[a] = lattice.last_voxel(q[a]);
  if (!grid.whole().holds({voxel, voxel + int64_t(1)})) return std::nullopt;
  return voxel;
}

// "  #rrggbb", or "  none".
void print_colour(const ColourView& colours, const LatticePoint& voxel) {
  const uint32_t colour = svdag_colour(colours, colours.dag.levels, uint32_t(voxel.x),
                                       uint32_t(voxel.y), uint32_t(voxel.z));
  if (colour == kNoColour) {
    std::printf("  none");
  } else {
    std::printf("  #%02x%02x%02x", colour & 255, colour >> 8 & 255, colour >> 16);
  }
}

// `colours`: of the file; null: it has none.
void print_cube(const DagFile& file, const DagColours* colours, const Grid& grid,
                const LatticePoint& voxel) {
  const CubeAt cube = cube_at(file.view(), voxel);
  const LatticePoint end = cube.min + (int64_t(1) << (grid.levels - cube.level));
  const Box box = world_box(grid, {cube.min, end});
  std::printf("%s %d  %.17g %.17g %.17g  %.17g %.17g %.17g", cube.set ? "set" : "empty",
              cube.level, box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z);
  if (cube.set && colours != nullptr) print_colour(colours->view(), voxel);
  std::putchar('\n');
}

}  // namespace

int run(const QueryCommand& command) {
  const DagFile file = open_dag(command.file);
  const Grid grid = file.grid();
  const Lattice lattice(grid);
  MemoryBudget budget(default_memory_limit());
  std::optional<DagColours> colours;
  if (file.has_colours()) colours.emplace(file, &budget);
  std::string line;
  for (uint64_t number = 1; read_line(number, &line); ++number) {
    check_interrupt();
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (const auto voxel = voxel_of(lattice, grid, parse_point(line, number))) {
      print_cube(file, colours ? &*colours : nullptr, grid, *voxel);
    } else {
      std::puts("outside");
    }
  }
  return int(ExitCode::kOk);
}

}  // namespace svdag
