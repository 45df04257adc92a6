// Colours of a file beside the same without loss: bytes, errors and speed.
//
//   colours_bench FILE LOSSLESS
//
// FILE is coloured as LOSSLESS, at the same level, with an error. Prints a line of JSON: bits per
// stored colour and per cube of level K; PSNR and largest error of the cubes of level K in 8-bit
// steps; encoded colours per second (CPU time of one thread); seconds to make the counts; and
// nanoseconds per look-up: at random, in Morton order, and of the voxel alone.
#include <cmath>
#include <cstdio>
#include <random>

#include "io/dag/colours/chunk_codec.h"
#include "io/dag/colours/dag_colours.h"
#include "streaming/error.h"
#include "tests/bench/stop_watch.h"
#include "tests/io/dag/colours/colour_rows.h"

namespace svdag {
namespace {

struct CubePlace {
  uint32_t x, y, z;
};

volatile uint64_t sink = 0;  // keeps what is measured

template <class Look>
double nanoseconds(const std::vector<CubePlace>& cubes, const Look& look) {
  const bench::StopWatch watch;
  uint64_t sum = 0;
  for (const CubePlace& c : cubes) sum += look(c);
  const double seconds = watch.cost().cpu;
  sink = sum;
  return 1e9 * seconds / double(cubes.size());
}

// Calls visit(x, y, z) for each covered cube of level K, in Morton order.
template <class Visit>
void for_cubes(const DagView& dag, uint32_t level, const CoveredCube& cube, const Visit& visit) {
  if (cube.level < level)
    return for_covered_children(
        dag, cube, [&](const CoveredCube& child) { for_cubes(dag, level, child, visit); });
  CubePlace at{0, 0, 0};
  for (uint32_t bit = 0; bit < level; ++bit) {
    const uint64_t octant = cube.morton >> 3 * bit;
    at.x |= uint32_t(octant >> 2 & 1) << bit;
    at.y |= uint32_t(octant >> 1 & 1) << bit;
    at.z |= uint32_t(octant & 1) << bit;
  }
  visit(at);
}

// Encodes the colours of the chunks of `lossless` anew: colours per second.
double encoding_speed(const DagFile& lossless, const ColourView& view, uint32_t max_squared) {
  ChunkEncoder encoder(max_squared);
  std::vector<uint32_t> colours, words;
  uint64_t encoded = 0;
  double seconds = 0;
  for (uint64_t i = 0; i < view.entry_count && encoded < 20'000'000; ++i) {
    const ColourEntry& entry = view.entries[i];
    if ((entry.value & kChunkEntry) == 0) continue;
    const uint64_t end =
        i + 1 < view.entry_count ? view.entries[i + 1].first : lossless.header().colour_count;
    colours.resize(size_t(end - entry.first));
    decode_chunk(view.chunks + (entry.value & ~kChunkEntry), colours);
    const bench::StopWatch watch;
    words.clear();
    encoder.encode(colours, &words);
    seconds += watch.cost().cpu;
    encoded += colours.size();
  }
  return seconds > 0 ? double(encoded) / seconds : 0;
}

void measure(const char* path, const char* lossless_path) {
  MemoryBudget budget;
  const DagFile file = DagFile::open(path), lossless = DagFile::open(lossless_path);
  const bench::StopWatch opening;
  const DagColours colours(file, &budget);
  const double counts = opening.cost().cpu;
  const DagColours reference(lossless, &budget);
  const ColourView& view = colours.view();
  const uint32_t level = view.level(), shift = view.dag.levels - level;
  std::mt19937_64 random(1);
  std::vector<CubePlace> at_random, ordered;
  double squared = 0;
  int worst = 0;
  uint64_t judged = 0, cubes = 0;
  for_cubes(view.dag, level, {}, [&](const CubePlace& c) {
    if (ordered.size() < 2'000'000) ordered.push_back(c);
    if (at_random.size() < 2'000'000) {
      at_random.push_back(c);
    } else if (const uint64_t at = random() % (cubes + 1); at < at_random.size()) {
      at_random[at] = c;
    }
    ++cubes;
    const uint32_t given = svdag_colour(reference.view(), level, c.x, c.y, c.z);
    if (given == kNoColour) return;
    const int e = squared_distance(svdag_colour(view, level, c.x, c.y, c.z), given);
    squared += e;
    worst = std::max(worst, e);
    ++judged;
  });
  std::ranges::shuffle(at_random, random);
  const auto colour = [&](const CubePlace& c) { return svdag_colour(view, level, c.x, c.y, c.z); };
  const auto voxel = [&](const CubePlace& c) {
    return uint32_t(dag_brick(view.dag, c.x << shift >> 2, c.y << shift >> 2, c.z << shift >> 2));
  };
  const double bits = 8.0 * double(file.header().chunks_bytes + file.header().directory_bytes);
  const uint32_t error = file.header().colour_error;
  const auto max_squared =  // as the writer of files has it
      uint32_t(uint64_t(error) * error / (uint64_t(kColourErrorUnit) * kColourErrorUnit));
  std::printf(
      "{\"level\":%u,\"colours\":%llu,\"bits\":%.3f,\"bits_per_cube\":%.3f,\"psnr\":%.2f,"
      "\"worst\":%.2f,\"encoded_per_second\":%.0f,\"counts_seconds\":%.3f,\"random_ns\":%.0f,"
      "\"ordered_ns\":%.0f,\"dag_ns\":%.0f}\n",
      level, static_cast<unsigned long long>(file.header().colour_count),
      bits / double(file.header().colour_count), bits / double(cubes),
      10 * std::log10(255.0 * 255 * 3 * double(judged) / (squared + 1e-9)), std::sqrt(worst),
      encoding_speed(lossless, reference.view(), max_squared), counts,
      nanoseconds(at_random, colour), nanoseconds(ordered, colour), nanoseconds(at_random, voxel));
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  if (argc != 3) return int(svdag::ExitCode::kUsage);
  try {
    svdag::measure(argv[1], argv[2]);
    return 0;
  } catch (const svdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(error.code());
  }
}
