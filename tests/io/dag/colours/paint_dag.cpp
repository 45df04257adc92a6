// Paints a `.svdag` with synthetic colours, or prints the colours of one, for tests.
//
//   paint_dag FILE OUT LEVEL ERROR      adds colours at LEVEL; ERROR in steps
//   paint_dag FILE                      the colours of all covered cubes: "level x y z rrggbb"
#include <cstdio>
#include <cstdlib>
#include <string>

#include "io/dag/colours/dag_colours.h"
#include "streaming/file/file.h"
#include "tests/io/dag/colours/painted_cubes.h"

namespace svdag {
namespace {

void paint(const char* from, const char* to, uint32_t level, double error) {
  MemoryBudget budget;
  ParallelExecutor executor(2);
  const DagFile dag = DagFile::open(from);
  PaintedCubes cubes(dag.view(), level, mixed_paint(level > 5 ? level - 4 : 1));
  write_coloured(dag, {level, uint32_t(error * kColourErrorUnit)}, cubes.source(), to,
                 {&budget, folder_of(to)}, &executor);
}

void print(const char* path) {
  MemoryBudget budget;
  const DagFile file = DagFile::open(path);
  const DagColours colours(file, &budget);
  for (uint32_t level = 0; level <= file.view().levels; ++level) {
    const uint32_t side = 1U << level;
    for (uint32_t x = 0; x < side; ++x)
      for (uint32_t y = 0; y < side; ++y)
        for (uint32_t z = 0; z < side; ++z) {
          const uint32_t colour = svdag_colour(colours.view(), level, x, y, z);
          if (colour == kNoColour) continue;
          std::printf("%u %u %u %u %02x%02x%02x\n", level, x, y, z, colour & 255, colour >> 8 & 255,
                      colour >> 16);
        }
  }
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  try {
    if (argc == 5) {
      svdag::paint(argv[1], argv[2], uint32_t(std::atoi(argv[3])), std::atof(argv[4]));
    } else if (argc == 2) {
      svdag::print(argv[1]);
    } else {
      return int(svdag::ExitCode::kUsage);
    }
    return 0;
  } catch (const svdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(error.code());
  }
}
