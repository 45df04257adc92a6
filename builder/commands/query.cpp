// `svdag query FILE.svdag < POINTS`: which points are in a set voxel, and its colour; or
// which voxel is the nearest.
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
#include "io/dag/nearest.h"
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

// What answers points.
struct QuerySource {
  DagFile file;
  Grid grid = file.grid();
  Lattice lattice{grid};
  std::optional<DagColours> colours = {};  // of a file that has them
};

// The box of voxels `min` to `end` - 1.
void print_box(const Grid& grid, const LatticePoint& min, const LatticePoint& end) {
  const Box box = world_box(grid, {min, end});
  std::printf("  %.17g %.17g %.17g  %.17g %.17g %.17g", box.min.x, box.min.y, box.min.z, box.max.x,
              box.max.y, box.max.z);
}

void print_cube(const QuerySource& source, const Point& point) {
  const auto voxel = voxel_of(source.lattice, source.grid, point);
  if (!voxel) {
    std::printf("outside");
    return;
  }
  const CubeAt cube = cube_at(source.file.view(), *voxel);
  std::printf("%s %d", cube.set ? "set" : "empty", cube.level);
  print_box(source.grid, cube.min, cube.min + (int64_t(1) << (source.grid.levels - cube.level)));
  if (cube.set && source.colours) print_colour(source.colours->view(), *voxel);
}

void print_nearest(const QuerySource& source, const Point& point, double max_distance) {
  double distance = 0;
  const NearestSetVoxel nearest =
      nearest_in_world(source.file.view(), {point.x, point.y, point.z}, max_distance, &distance);
  if (!nearest.found) {
    std::printf("none");
    return;
  }
  const LatticePoint voxel(nearest.voxel[0], nearest.voxel[1], nearest.voxel[2]);
  std::printf("near %.17g", distance);
  print_box(source.grid, voxel, voxel + int64_t(1));
  if (source.colours) print_colour(source.colours->view(), voxel);
}

}  // namespace

int run(const QueryCommand& command) {
  MemoryBudget budget(default_memory_limit());
  QuerySource source{.file = open_dag(command.file)};
  if (source.file.has_colours()) source.colours.emplace(source.file, &budget);
  std::string line;
  for (uint64_t number = 1; read_line(number, &line); ++number) {
    check_interrupt();
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const Point point = parse_point(line, number);
    if (command.nearest) {
      print_nearest(source, point, command.max_distance);
    } else {
      print_cube(source, point);
    }
    std::putchar('\n');
  }
  return int(ExitCode::kOk);
}

}  // namespace svdag
