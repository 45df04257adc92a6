// `trace_bench FILE.svdag [px,py,pz,tx,ty,tz]`: rays per second of one CPU thread.
//
// The workloads of verify/trace/kernel/workload.h for a picture of 320 x 176 pixels, 16 rays per
// pixel for soft shadows and ambient occlusion, whose rays are a twentieth of the scene long.
// Three methods: the plain traversal, the fast one of the file, and that of the 64-tree. All
// results of the fast methods are compared with those of the plain traversal.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "io/dag/dag_file.h"
#include "tests/verify/trace/plain_traversal.h"
#include "verify/trace/kernel/rays.h"
#include "verify/trace/kernel/tree64.h"
#include "verify/trace/kernel/workload.h"
#include "verify/trace/presets.h"

namespace svdag {
namespace {

// CPU time of this process, so that other load does not count.
double now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

struct Batch {
  const char* name;
  std::vector<Ray> rays;
  Span span;
  Cut cut;
  std::vector<Hit> hits;
};

template <typename Run>
double rate(size_t rays, const Run& run) {
  double best = 1e300;
  for (int round = 0; round < 3; ++round) {
    const double start = now();
    run();
    best = std::min(best, now() - start);
  }
  return 1e-6 * double(rays) / best;
}

bool same_voxel(const Hit& a, const Hit& b) {
  return a.found == b.found && a.t == b.t && a.axis == b.axis && a.voxel[0] == b.voxel[0] &&
         a.voxel[1] == b.voxel[1] && a.voxel[2] == b.voxel[2];
}

// Returns the number of hits that differ.
uint64_t measure(const DagView& dag, const Tree64View& tree, Batch* batch) {
  const size_t n = batch->rays.size();
  std::vector<Hit> plain(n);
  batch->hits.resize(n);
  const double slow = rate(n, [&] {
    for (size_t i = 0; i < n; ++i)
      plain[i] = plain_closest(dag, batch->rays[i], batch->span, batch->cut);
  });
  const double fast = rate(n, [&] {
    trace_closest(dag, batch->rays.data(), n, batch->span, batch->cut, batch->hits.data());
  });
  std::vector<Hit> hits(n);
  const double faster = rate(n, [&] {
    trace_closest(dag, tree, batch->rays.data(), n, batch->span, batch->cut, hits.data());
  });
  uint64_t steps = 0, entered = 0, different = 0;
  for (size_t i = 0; i < n; ++i) {
    steps += batch->hits[i].steps;
    entered += hits[i].steps;
    different += !same_voxel(plain[i], batch->hits[i]) + !same_voxel(plain[i], hits[i]);
  }
  std::printf("| %-13s | %7zu | %5.2f | %5.2f | %5.2f | %5.1f | %5.1f | %llu |\n", batch->name, n,
              slow, fast, faster, double(steps) / double(n), double(entered) / double(n),
              static_cast<unsigned long long>(different));
  return different;
}

// Primary rays again, tile by tile; the time includes that of their beams.
double beam_rate(const DagView& dag, const Tree64View& tree, const Picture& picture,
                 const Batch& primary, std::vector<Hit>* all) {
  std::vector<Hit>& hits = *all;
  hits.resize(primary.rays.size());
  return rate(hits.size(), [&] {
    for (size_t tile = 0; tile < hits.size() / (kTile * kTile); ++tile) {
      const uint32_t columns = picture.width / kTile;
      const Span span = tile_span(dag, picture, uint32_t(tile) % columns * kTile,
                                  uint32_t(tile) / columns * kTile);
      const size_t first = tile * kTile * kTile;
      trace_closest(dag, tree, &primary.rays[first], kTile * kTile, span, {}, &hits[first]);
    }
  });
}

uint64_t measure_beams(const DagView& dag, const Tree64View& tree, const Picture& picture,
                       const Batch& primary) {
  std::vector<Hit> hits[2];
  const double fast = beam_rate(dag, {}, picture, primary, &hits[0]);
  const double faster = beam_rate(dag, tree, picture, primary, &hits[1]);
  uint64_t steps[2] = {}, different = 0;
  for (int way = 0; way < 2; ++way) {
    for (size_t i = 0; i < primary.hits.size(); ++i) {
      steps[way] += hits[way][i].steps;
      different += !same_voxel(primary.hits[i], hits[way][i]);
    }
  }
  const double n = double(primary.hits.size());
  std::printf("| %-13s | %7.0f |       | %5.2f | %5.2f | %5.1f | %5.1f | %llu |\n",
              "primary, beams", n, fast, faster, double(steps[0]) / n, double(steps[1]) / n,
              static_cast<unsigned long long>(different));
  return different;
}

Camera camera_of(const DagFile& file, const char* text) {
  const VoxelBounds box = framing_bounds(file.view());
  double c[6];
  if (text == nullptr ||
      std::sscanf(text, "%lf,%lf,%lf,%lf,%lf,%lf", c, c + 1, c + 2, c + 3, c + 4, c + 5) != 6)
    return preset_camera("inside", file.view(), box, 1, 60, 320.0 / 176);
  const Point corner = file.grid().corner();
  Vec3 at, to;
  for (int a = 0; a < 3; ++a) {
    at[a] = (c[a] - corner[a]) / file.grid().voxel_size;
    to[a] = (c[a + 3] - corner[a]) / file.grid().voxel_size;
  }
  return look_at(at, to, 1, 60, 320.0 / 176);
}

int run(int argc, char** argv) {
  constexpr uint32_t kSamples = 16;
  const DagFile file = DagFile::open(argv[1]);
  const DagView& dag = file.view();
  const double start = now();
  const Tree64 tree(dag);
  std::printf("64-tree: %.1f MB of %.1f MB in %.2f s\n\n", 1e-6 * double(tree.bytes()),
              1e-6 * double(file.header().file_bytes), now() - start);
  const VoxelBounds box = framing_bounds(dag);
  const Picture picture{camera_of(file, argc > 2 ? argv[2] : nullptr), 320, 176};
  const double diagonal = length(box.max - box.min);
  Light light{(box.min + box.max) * 0.5, 0.02 * diagonal};
  light.centre[1] += 0.4 * (box.max[1] - box.min[1]);
  Batch primary{"primary", {}, {}, {}, {}}, shadow{"shadow", {}, {0, 1}, {}, {}},
      soft{"soft", {}, {0, 1}, {}, {}}, ao{"ao", {}, {0, 0.05 * diagonal}, {}, {}};
  const uint32_t columns = picture.width / kTile;
  for (uint32_t i = 0; i < picture.width * picture.height; ++i) {  // tile by tile
    const uint32_t tile = i / (kTile * kTile), within = i % (kTile * kTile);
    primary.rays.push_back(picture.ray(tile % columns * kTile + within % kTile,
                                       tile / columns * kTile + within / kTile));
  }
  std::printf(
      "| rays | number | plain, MRays/s | file, MRays/s | 64-tree, MRays/s | steps per ray | nodes "
      "per ray | different |\n"
      "| --- | --: | --: | --: | --: | --: | --: | --: |\n");
  uint64_t different = measure(dag, tree.view(), &primary);
  different += measure_beams(dag, tree.view(), picture, primary);
  for (size_t i = 0; i < primary.rays.size(); ++i) {
    const Surfel surfel = make_surfel(dag, primary.rays[i], primary.hits[i]);
    if (!surfel.found) continue;
    shadow.rays.push_back(shadow_ray(surfel, light));
    for (uint32_t k = 0; k < kSamples; ++k) {
      soft.rays.push_back(soft_ray(surfel, light, i, k, kSamples));
      ao.rays.push_back(occlusion_ray(surfel, i, k, kSamples));
    }
  }
  Batch cone = ao;
  cone.name = "ao, cone 9";
  cone.cut.spread = 0.31676888064907255;  // 2 * tangent of 9 degrees
  for (Batch* batch : {&shadow, &soft, &ao, &cone}) different += measure(dag, tree.view(), batch);
  return different == 0 ? 0 : 1;
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: trace_bench FILE.svdag [px,py,pz,tx,ty,tz]\n");
    return 2;
  }
  return svdag::run(argc, argv);
}
