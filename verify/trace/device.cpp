#include "verify/trace/device.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "verify/trace/processor.h"

namespace svdag {
namespace {

double now() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since).count();
}

// body(row) for every row of tiles, on all threads.
template <typename Body>
void for_each_row(const Workload& work, const Body& body) {
  const uint32_t rows = (work.picture.height + kTile - 1) / kTile;
  std::atomic<uint32_t> next{0};
  const auto loop = [&] {
    run_fast([&] {
      for (uint32_t row = next++; row < rows; row = next++) body(row);
    });
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < work.threads; ++i) threads.emplace_back(loop);
  loop();
  for (std::thread& thread : threads) thread.join();
}

// The least time of `rounds` runs.
template <typename Run>
double least(uint32_t rounds, const Run& run) {
  double best = 1e300;
  for (uint32_t round = 0; round < rounds; ++round) {
    const double start = now();
    run();
    best = std::min(best, now() - start);
  }
  return best;
}

void trace_tile(const DagView& dag, const Workload& work, uint32_t left, uint32_t top,
                std::vector<Hit>* hits) {
  const Picture& picture = work.picture;
  const Span span = work.beams ? tile_span(dag, picture, left, top) : Span{};
  Tracer tracer(dag);
  for (uint32_t i = 0; i < kTile * kTile; ++i) {
    const uint32_t x = left + i % kTile, y = top + i / kTile;
    if (x < picture.width && y < picture.height)
      (*hits)[size_t(y) * picture.width + x] = tracer.closest(picture.ray(x, y), span);
  }
}

// One of the secondary workloads, for the pixels of one row of tiles.
void trace_row(const DagView& dag, const Workload& work, int kind, uint32_t row,
               const std::vector<Surfel>& surfels, std::vector<uint32_t>* blocked) {
  const size_t width = work.picture.width;
  const size_t end = std::min<size_t>((row + 1) * kTile, work.picture.height) * width;
  Tracer tracer(dag);
  for (size_t pixel = row * kTile * width; pixel < end; ++pixel) {
    if (!surfels[pixel].found) continue;
    uint32_t count = 0;
    for (uint32_t i = 0; i < rays_per_pixel(work, kind); ++i)
      count += blocked_ray(&tracer, work, kind, surfels[pixel], pixel, i);
    (*blocked)[pixel] = count;
  }
}

}  // namespace

Answers trace_on_cpu(const PlainFile& file, const Workload& asked) {
  Workload work = asked;
  if (work.threads == 0) work.threads = std::max(1U, std::thread::hardware_concurrency());
  const DagView& dag = file.view;
  const Picture& picture = work.picture;
  const size_t pixels = size_t(picture.width) * picture.height;
  Answers answers;
  answers.device =
      "CPU, " + std::to_string(work.threads) + (work.threads == 1 ? " thread" : " threads");
  answers.hits.resize(pixels);
  answers.surfels.resize(pixels);
  answers.rays[kPrimaryRays] = pixels;
  answers.seconds[kPrimaryRays] = least(work.rounds, [&] {
    for_each_row(work, [&](uint32_t row) {
      for (uint32_t x = 0; x < picture.width; x += kTile)
        trace_tile(dag, work, x, row * kTile, &answers.hits);
    });
  });
  uint64_t found = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const uint32_t x = uint32_t(i % picture.width), y = uint32_t(i / picture.width);
    answers.surfels[i] = make_surfel(dag, picture.ray(x, y), answers.hits[i]);
    found += answers.hits[i].found;
  }
  for (int kind = kShadowRays; kind < kWorkloads; ++kind) {
    answers.blocked[kind].assign(pixels, 0);
    answers.rays[kind] = found * rays_per_pixel(work, kind);
    answers.seconds[kind] = least(work.rounds, [&] {
      for_each_row(work, [&](uint32_t row) {
        trace_row(dag, work, kind, row, answers.surfels, &answers.blocked[kind]);
      });
    });
  }
  return answers;
}

}  // namespace svdag
