#include "verify/trace/program/device.h"

#include <algorithm>

#include "streaming/memory/memory_budget.h"
#include "streaming/process/executor.h"
#include "streaming/process/lap_timer.h"
#include "verify/trace/kernel/processor.h"
#include "verify/trace/kernel/rays.h"
#include "verify/trace/kernel/tree64.h"

namespace svdag {
namespace {

// Calls body(row) for every row of tiles, in parallel.
template <typename Body>
void for_each_row(Executor& executor, const Picture& picture, const Body& body) {
  executor.for_each((picture.height + kTile - 1) / kTile,
                    [&](size_t, size_t row) { body(uint32_t(row)); });
}

// The shortest time of `rounds` runs, in seconds.
template <typename Run>
double min_seconds(uint32_t rounds, const Run& run) {
  double best = 1e300;
  for (uint32_t round = 0; round < rounds; ++round) {
    LapTimer seconds;
    run();
    best = std::min(best, seconds.lap());
  }
  return best;
}

void trace_tile(const DagView& dag, const Tree64View& tree, const Workload& work, uint32_t left,
                uint32_t top, std::vector<Hit>* hits) {
  const Picture& picture = work.picture;
  Ray rays[kTile * kTile];
  Hit found[kTile * kTile];
  for (uint32_t i = 0; i < kTile * kTile; ++i)
    rays[i] = picture.ray(left + i % kTile, top + i / kTile);
  Span span;
  if (work.beams) run_fast([&] { span = tile_span(dag, picture, left, top); });
  trace_closest(dag, tree, rays, kTile * kTile, span, {}, found);
  for (uint32_t i = 0; i < kTile * kTile; ++i) {
    const uint32_t x = left + i % kTile, y = top + i / kTile;
    if (x < picture.width && y < picture.height) (*hits)[size_t(y) * picture.width + x] = found[i];
  }
}

// Traces a secondary workload for the pixels of one row of tiles, in batches of several hundred
// rays.
void trace_row(const DagView& dag, const Tree64View& tree, const Workload& work, int kind,
               uint32_t row, const std::vector<Surfel>& surfels, std::vector<uint32_t>* blocked) {
  constexpr size_t kBatch = 512;
  const size_t width = work.picture.width;
  const size_t end = std::min<size_t>((row + 1) * kTile, work.picture.height) * width;
  std::vector<Ray> rays;
  std::vector<size_t> pixels;  // [i]: the pixel of rays[i]
  std::vector<uint8_t> found;
  for (size_t pixel = row * kTile * width; pixel < end; ++pixel) {
    for (uint32_t i = 0; surfels[pixel].found && i < rays_per_pixel(work, kind); ++i) {
      rays.push_back(secondary_ray(work, kind, surfels[pixel], pixel, i));
      pixels.push_back(pixel);
    }
    if (rays.size() < kBatch && pixel + 1 < end) continue;
    found.resize(rays.size());
    trace_any(dag, tree, rays.data(), rays.size(), secondary_span(work, kind),
              secondary_cut(work, kind), found.data());
    for (size_t i = 0; i < rays.size(); ++i) (*blocked)[pixels[i]] += found[i];
    rays.clear();
    pixels.clear();
  }
}

// Memory for the 64-tree: what the file and the results leave of the limit.
uint64_t memory_left(const PlainFile& file, size_t pixels) {
  const uint64_t used = file.bytes() + pixels * kResultBytesPerPixel;
  const uint64_t limit = default_memory_limit();
  return used < limit ? limit - used : 0;
}

// Upper bound of the number of rays without a cut.
uint64_t uncut_rays(const DagView& dag, const Workload& work) {
  uint64_t per_pixel = 0;
  for (int kind = 0; kind < kWorkloads; ++kind) {
    if (!secondary_cut(work, kind).cuts(dag.levels)) per_pixel += rays_per_pixel(work, kind);
  }
  return per_pixel * work.picture.width * work.picture.height * work.rounds;
}

}  // namespace

TraceResults trace_on_cpu(const PlainFile& file, const Workload& work) {
  ParallelExecutor executor(threads_or_all(work.threads));
  const size_t threads = executor.workers();
  const DagView& dag = file.view;
  const Picture& picture = work.picture;
  const size_t pixels = size_t(picture.width) * picture.height;
  TraceResults results;
  results.device = "CPU, " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
  const Tree64 built =
      tree_if_it_pays(dag, uncut_rays(dag, work) / threads, memory_left(file, pixels));
  const Tree64View& tree = built.view();
  results.hits.resize(pixels);
  results.surfels.resize(pixels);
  results.rays[kPrimaryRays] = pixels;
  results.seconds[kPrimaryRays] = min_seconds(work.rounds, [&] {
    for_each_row(executor, picture, [&](uint32_t row) {
      for (uint32_t x = 0; x < picture.width; x += kTile)
        trace_tile(dag, tree, work, x, row * kTile, &results.hits);
    });
  });
  results.layers.assign(pixels, kNoLayer);
  if (file.index) {
    for_each_row(executor, picture, [&](uint32_t row) {
      const size_t end = std::min<size_t>((row + 1) * kTile, picture.height) * picture.width;
      for (size_t i = size_t(row) * kTile * picture.width; i < end; ++i)
        results.layers[i] = layer_of_hit(dag, file.index->view(), results.hits[i]);
    });
  }
  uint64_t found = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const uint32_t x = uint32_t(i % picture.width), y = uint32_t(i / picture.width);
    results.surfels[i] = make_surfel(dag, picture.ray(x, y), results.hits[i]);
    found += results.hits[i].found;
  }
  for (int kind = kShadowRays; kind < kWorkloads; ++kind) {
    results.rays[kind] = found * rays_per_pixel(work, kind);
    results.seconds[kind] = min_seconds(work.rounds, [&] {
      results.blocked[kind].assign(pixels, 0);
      for_each_row(executor, picture, [&](uint32_t row) {
        trace_row(dag, tree, work, kind, row, results.surfels, &results.blocked[kind]);
      });
    });
  }
  return results;
}

}  // namespace svdag
