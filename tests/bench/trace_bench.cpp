// Rays per second through a DAG, one thread: trace_bench FILE.svdag [px,py,pz,tx,ty,tz]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <sys/mman.h>
#include <vector>

#include "io/dag/dag_file.h"
#include "tests/verify/trace/plain_traversal.h"
#include "verify/trace/rays.h"
#include "verify/trace/workload.h"

namespace svdag {
namespace {

// Of this process's processor time: the machine may have other work.
double now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

struct Batch {
  const char* name;
  std::vector<Ray> rays;
  Span span;
};

void measure(const DagView& dag, const Batch& batch) {
  uint64_t sums[4] = {}, steps[4] = {};
  double seconds[4] = {1e9, 1e9, 1e9, 1e9};
  for (int round = 0; round < 3; ++round) {
    for (int how = 0; how < 4; ++how) {
      uint64_t sum = 0, n = 0;
      Tracer tracer(dag);
      std::vector<Hit> hits(batch.rays.size());
      const double start = now();
      if (how == 3) trace_closest(dag, batch.rays.data(), batch.rays.size(), batch.span, {}, hits.data());
      for (const Ray& ray : batch.rays) {
        const Hit hit = how == 3 ? hits[size_t(&ray - batch.rays.data())] : how == 0   ? plain_closest(dag, ray, batch.span)
                        : how == 1 ? trace_closest(dag, ray, batch.span)
                                   : tracer.closest(ray, batch.span);
        sum = sum * 31 + hit.found + hit.voxel[0] + 3 * hit.voxel[1] + 7 * hit.voxel[2] + uint64_t(hit.axis);
        n += hit.steps;
      }
      seconds[how] = std::min(seconds[how], now() - start);
      sums[how] = sum;
      steps[how] = n;
    }
  }
  std::printf("%-8s %8zu rays", batch.name, batch.rays.size());
  for (int how = 0; how < 4; ++how)
    std::printf("  %6.2f MRays/s (%5.1f steps)", 1e-6 * double(batch.rays.size()) / seconds[how],
                double(steps[how]) / double(batch.rays.size()));
  std::printf("%s\n", sums[0] == sums[1] && sums[1] == sums[2] && sums[3] == sums[1] ? "" : "  DIFFERENT");
}

int run(int argc, char** argv) {
  const DagFile file = DagFile::open(argv[1]);
  DagView dag = file.view();
  if (std::getenv("HUGE")) {
    const size_t size = (file.header().file_bytes + (1 << 21)) & ~size_t((1 << 21) - 1);
    void* p = std::aligned_alloc(1 << 21, size);
    madvise(p, size, MADV_HUGEPAGE);
    memcpy(p, &file.header(), file.header().file_bytes);
    dag = dag_view(p);
  }
  const VoxelBounds box = occupied_bounds(dag);
  Vec3 at = box.min + (box.max - box.min) * 0.5, to = at;
  at[0] = box.min[0] + 0.25 * (box.max[0] - box.min[0]);
  if (argc > 2) {
    double c[6];
    std::sscanf(argv[2], "%lf,%lf,%lf,%lf,%lf,%lf", c, c + 1, c + 2, c + 3, c + 4, c + 5);
    const Point corner = file.grid().corner();
    for (int a = 0; a < 3; ++a) {
      at[a] = (c[a] - corner[a]) / file.grid().voxel_size;
      to[a] = (c[a + 3] - corner[a]) / file.grid().voxel_size;
    }
  }
  const Picture picture{look_at(at, to, 1, 60, 16.0 / 9), 320, 180};
  const double diagonal = length(box.max - box.min);
  const Light light{to + Vec3{{0, 0.45 * (box.max[1] - box.min[1]), 0}}, 0.02 * diagonal};
  Batch primary{"primary", {}, {}}, shadow{"shadow", {}, {0, 1}}, soft{"soft", {}, {0, 1}},
      ao{"ao", {}, {}}, near{"ao 5%", {}, {0, 0.05 * diagonal}};
  for (uint32_t y = 0; y < picture.height; ++y)
    for (uint32_t x = 0; x < picture.width; ++x) primary.rays.push_back(picture.ray(x, y));
  for (uint32_t y = 0; y < picture.height; ++y) {
    for (uint32_t x = 0; x < picture.width; ++x) {
      const Ray& ray = primary.rays[y * picture.width + x];
      const Surfel surfel = make_surfel(dag, ray, trace_closest(dag, ray));
      if (!surfel.found) continue;
      shadow.rays.push_back(shadow_ray(surfel, light));
      if (x % 4 != 0 || y % 4 != 0) continue;
      for (uint32_t i = 0; i < 64; ++i) {
        soft.rays.push_back(soft_ray(surfel, light, y * 640 + x, i, 64));
        ao.rays.push_back(occlusion_ray(surfel, y * 640 + x, i, 64));
      }
    }
  }
  near.rays = ao.rays;
  for (const Batch* batch : {&primary, &shadow, &soft, &ao, &near}) measure(dag, *batch);
  return 0;
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  return svdag::run(argc, argv);
}
