// Colours of a file, painted by functions of the position: bytes, errors and speed.
//
//   colours_bench FILE LEVEL ERROR OUT
//
// Prints a line of JSON: bits per colour, PSNR and largest error of all decoded colours in 8-bit
// steps, encoded colours per second (CPU time of one thread, without the painting), and nanoseconds
// per look-up of a voxel's colour: at random, in Morton order, and of the DAG alone.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "io/dag/colours/chunk_codec.h"
#include "io/dag/colours/dag_colours.h"
#include "streaming/error.h"
#include "streaming/file/file.h"
#include "tests/bench/stop_watch.h"
#include "tests/io/dag/colours/colour_rows.h"
#include "tests/io/dag/colours/painted_cubes.h"

namespace svdag {
namespace {

struct Voxel {
  uint32_t x, y, z;
};

// Covered cubes of K, at random.
std::vector<Voxel> sample(const std::vector<Voxel>& cubes, size_t count) {
  std::mt19937_64 random(1);
  std::vector<Voxel> chosen(count);
  for (Voxel& voxel : chosen) voxel = cubes[random() % cubes.size()];
  return chosen;
}

volatile uint64_t sink = 0;  // keeps what is measured

template <class Look>
double nanoseconds(const std::vector<Voxel>& cubes, const Look& look) {
  const bench::StopWatch watch;
  uint64_t sum = 0;
  for (const Voxel& c : cubes) sum += look(c);
  const double seconds = watch.cost().cpu;
  sink = sum;
  return 1e9 * seconds / double(cubes.size());
}

void measure(const char* from, uint32_t level, double error, const char* to) {
  MemoryBudget budget;
  SequentialExecutor executor;
  const DagFile dag = DagFile::open(from);
  const auto paint = mixed_paint(level > 5 ? level - 4 : 1);
  std::vector<Voxel> cubes;
  const auto remember = [&](uint32_t x, uint32_t y, uint32_t z, CubeColour* colour) {
    paint(x, y, z, colour);
    if (cubes.size() < 20'000'000) cubes.push_back({x, y, z});
  };
  double painting = 0;
  {
    PaintedCubes painted(dag.view(), level, remember);
    const CubeColourSource source = painted.source();
    const bench::StopWatch watch;
    while (!source().empty()) {
    }
    painting = watch.cost().cpu;
  }
  cubes.clear();
  PaintedCubes painted(dag.view(), level, remember);
  const bench::StopWatch watch;
  const Header header = write_coloured(dag, {level, uint32_t(error * kColourErrorUnit)},
                                       painted.source(), to, {&budget, folder_of(to)}, &executor);
  const double writing = watch.cost().cpu;

  const DagFile file = DagFile::open(to);
  const bench::StopWatch opening;
  const DagColours colours(file, &budget);
  const double counts = opening.cost().cpu;
  const ColourView& view = colours.view();
  double squared = 0;
  int worst = 0;
  uint64_t judged = 0;
  for (const Voxel& c : cubes) {
    CubeColour given{0, uint8_t(level), true, false, {}};
    paint(c.x, c.y, c.z, &given);
    const uint32_t found = svdag_colour(view, level, c.x, c.y, c.z);
    if (!given.has_colour) continue;
    const int e = squared_distance(
        found,
        rgb(srgb_code(given.linear[0]), srgb_code(given.linear[1]), srgb_code(given.linear[2])));
    squared += e;
    worst = std::max(worst, e);
    ++judged;
  }
  const auto colour = [&](const Voxel& c) { return svdag_colour(view, level, c.x, c.y, c.z); };
  const auto random = sample(cubes, 2'000'000);
  const uint32_t shift = dag.view().levels - level;
  const auto voxel = [&](const Voxel& c) {
    return uint32_t(dag_brick(view.dag, c.x << shift >> 2, c.y << shift >> 2, c.z << shift >> 2));
  };
  const std::vector<Voxel> ordered(
      cubes.begin(), cubes.begin() + std::ptrdiff_t(std::min<size_t>(cubes.size(), 2'000'000)));
  std::printf(
      "{\"colours\":%llu,\"bits\":%.3f,\"psnr\":%.2f,\"worst\":%.2f,\"encoded_per_second\":%.0f,"
      "\"counts_seconds\":%.3f,\"random_ns\":%.0f,\"ordered_ns\":%.0f,\"dag_ns\":%.0f}\n",
      static_cast<unsigned long long>(header.colour_count),
      8.0 * double(header.chunks_bytes + header.directory_bytes) / double(header.colour_count),
      10 * std::log10(255.0 * 255 * 3 * double(judged) / (squared + 1e-9)), std::sqrt(worst),
      double(header.colour_count) / (writing - painting), counts, nanoseconds(random, colour),
      nanoseconds(ordered, colour), nanoseconds(random, voxel));
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  if (argc != 5) return int(svdag::ExitCode::kUsage);
  try {
    svdag::measure(argv[1], uint32_t(std::atoi(argv[2])), std::atof(argv[3]), argv[4]);
    return 0;
  } catch (const svdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(error.code());
  }
}
