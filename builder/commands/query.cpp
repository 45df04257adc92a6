// `svdag query FILE.svdag < POINTS`: which points are in a set voxel, and its colour; or
// which voxel is the nearest.
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "builder/commands/commands.h"
#include "io/colour.h"
#include "io/dag/colours/dag_colours.h"
#include "io/dag/dag_file.h"
#include "io/dag/open_dag.h"
#include "io/dag/walk/cube_at.h"
#include "io/dag/walk/nearest.h"
#include "io/dag/walk/occupied_bounds.h"
#include "io/lattice.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/system_call.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr const char* kInput = "standard input";
constexpr size_t kMaxLine = 65536;  // bytes
constexpr size_t kTogether = 32;    // points that are looked up together, to hide the memory's time

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
void append_colour(std::string* out, const ColourView& colours, const LatticePoint& voxel) {
  const uint32_t colour = svdag_colour(colours, colours.dag.levels, uint32_t(voxel.x),
                                       uint32_t(voxel.y), uint32_t(voxel.z));
  *out += "  ";
  *out += colour == kNoColour
              ? "none"
              : colour_text({uint8_t(colour), uint8_t(colour >> 8), uint8_t(colour >> 16)});
}

// What answers points.
struct QuerySource {
  DagFile file;
  Grid grid = file.grid();
  Lattice lattice{grid};
  std::optional<DagColours> colours = {};  // of a file that has them
};

// The box of voxels `min` to `end` - 1.
void append_box(std::string* out, const Grid& grid, const LatticePoint& min,
                const LatticePoint& end) {
  const Box box = world_box(grid, {min, end});
  for (const Point& corner : {box.min, box.max}) {
    for (int a = 0; a < 3; ++a) {
      *out += a == 0 ? "  " : " ";
      *out += format_double(corner[a]);
    }
  }
}

void append_cube(std::string* out, const QuerySource& source, const Point& point) {
  const auto voxel = voxel_of(source.lattice, source.grid, point);
  if (!voxel) {
    *out += "outside\n";
    return;
  }
  const CubeAt cube = cube_at(source.file.view(), *voxel);
  *out += (cube.set ? "set " : "empty ") + std::to_string(cube.level);
  append_box(out, source.grid, cube.min,
             cube.min + (int64_t(1) << (source.grid.levels - cube.level)));
  if (cube.set && source.colours) append_colour(out, source.colours->view(), *voxel);
  *out += '\n';
}

void append_nearest(std::string* out, const QuerySource& source, std::span<const Point> points,
                    double max_distance) {
  const DagView& dag = source.file.view();
  int64_t units[kTogether][3] = {};
  std::array<bool, kTogether> is_near;
  std::array<NearestPath, kTogether> paths;
  for (size_t i = 0; i < points.size(); ++i)
    is_near[i] = snap_for_nearest(dag, {points[i].x, points[i].y, points[i].z}, units[i]);
  find_paths(dag, units, points.size(), paths.data());
  for (size_t i = 0; i < points.size(); ++i) {
    double distance = 0;
    NearestSetVoxel nearest;
    if (is_near[i]) nearest = nearest_within(dag, units[i], paths[i], max_distance, &distance);
    if (!nearest.found) {
      *out += "none\n";
      continue;
    }
    const LatticePoint voxel(nearest.voxel[0], nearest.voxel[1], nearest.voxel[2]);
    *out += "near " + format_double(distance);
    append_box(out, source.grid, voxel, voxel + int64_t(1));
    if (source.colours) append_colour(out, source.colours->view(), voxel);
    *out += '\n';
  }
}

}  // namespace

int run(const QueryCommand& command) {
  MemoryBudget budget(default_memory_limit());
  QuerySource source{.file = open_dag(command.file)};
  if (source.file.has_colours()) source.colours.emplace(source.file, &budget);
  const size_t together = isatty(STDIN_FILENO) != 0 ? 1 : kTogether;
  std::string line, answers;
  std::vector<Point> points;
  const auto answer = [&] {
    answers.clear();
    if (command.nearest) {
      append_nearest(&answers, source, points, command.max_distance);
    } else {
      for (const Point& point : points) append_cube(&answers, source, point);
    }
    points.clear();
    std::fwrite(answers.data(), 1, answers.size(), stdout);
  };
  try {
    for (uint64_t number = 1; read_line(number, &line); ++number) {
      check_interrupt();
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      points.push_back(parse_point(line, number));
      if (points.size() == together) answer();
    }
  } catch (const Error&) {
    answer();  // the points before it
    throw;
  }
  answer();
  return int(ExitCode::kOk);
}

}  // namespace svdag
