// `readers_bench SCENE...`: measures the speed of the scene readers, a line per file.
//
// Time is CPU time of the process (including system calls), the minimum of several passes over the
// file, into a sink that counts and into Scene::bounds(). The first pass fills the page cache, so
// the disk is not measured.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <limits>
#include <string>

#include "io/scene/scene.h"
#include "streaming/error.h"

namespace svdag::bench {
namespace {

constexpr int kRounds = 5;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

template <class Work>
double least_seconds(const Work& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    const double start = cpu_seconds();
    work();
    least = std::min(least, cpu_seconds() - start);
  }
  return least;
}

void measure(const std::string& path) {
  MemoryBudget budget;
  const Scene scene({{path}, {}, false}, &budget);
  uint64_t triangles = 0;
  const double streaming = least_seconds([&] {
    triangles = 0;
    scene.stream([&](const TriangleBatch& batch) { triangles += batch.triangles.size(); });
  });
  const double bounds = least_seconds([&] { scene.bounds(); });
  const double millions = double(triangles) / 1e6;
  const double megabytes = double(File::open_read(path).size()) / 1e6;
  std::printf("| %s | %llu | %.4f | %.1f | %.0f | %.4f | %.1f |\n",
              path.substr(path.find_last_of('/') + 1).c_str(),
              static_cast<unsigned long long>(triangles), streaming, millions / streaming,
              megabytes / streaming, bounds, millions / bounds);
  std::fflush(stdout);
}

}  // namespace
}  // namespace svdag::bench

int main(int argc, char** argv) {
  std::puts(
      "| scene | triangles | CPU s | M triangles/s | MB/s | CPU s, bounds | M triangles/s, bounds "
      "|");
  std::puts("| --- | --: | --: | --: | --: | --: | --: |");
  try {
    for (int i = 1; i < argc; ++i) svdag::bench::measure(argv[i]);
  } catch (const svdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(error.code());
  }
}
