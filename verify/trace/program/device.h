// Traces the four measured workloads on the processor or on a GPU: same rays, same results.
#pragma once

#include <string>
#include <vector>

#include "verify/trace/kernel/workload.h"
#include "verify/trace/program/plain_file.h"

namespace svdag {

struct Workload {
  Picture picture;
  Light light;
  Secondary secondary;
  bool beams = true;      // primary rays start where the beam of their tile first meets a cube
  bool gpu_tree = false;  // a GPU traces the 64-tree of the file where rays are not cut
  uint32_t rounds = 3;    // repetitions; the shortest time counts
  unsigned threads = 0;   // on the processor; 0: one per processor
};

enum WorkloadKind { kPrimaryRays, kShadowRays, kSoftRays, kOcclusionRays, kWorkloads };

constexpr const char* kWorkloadNames[kWorkloads] = {"primary", "shadow", "soft", "ao"};

// Vectors are indexed by pixel, row by row from the top.
struct TraceResults {
  std::string device;     // for people
  std::vector<Hit> hits;  // of the primary rays
  std::vector<Surfel> surfels;
  std::vector<uint32_t> layers;  // the first that holds the voxel hit; kNoLayer: no hit, or the
                                 // file has no layers
  std::vector<uint32_t> blocked[kWorkloads];  // number of secondary rays that hit something
  double seconds[kWorkloads] = {};
  uint64_t rays[kWorkloads] = {};
};

// Memory of the results of a pixel.
constexpr uint64_t kResultBytesPerPixel = sizeof(Hit) + sizeof(Surfel) + 4 * sizeof(uint32_t);

TraceResults trace_on_cpu(const PlainFile& file, const Workload& work);

// Error: kUsage without a device or in a build without CUDA; kMemory if the device's memory does
// not suffice.
TraceResults trace_on_cuda(const PlainFile& file, const Workload& work);

SVDAG_HD inline uint32_t layer_of_hit(const DagView& dag, const LayerIndexView& index,
                                      const Hit& hit) {
  if (!hit.found) return kNoLayer;
  return layer_of_cube(dag, index, hit.level, hit.voxel[0], hit.voxel[1], hit.voxel[2]);
}

// Secondary ray i of workload `kind` from a surfel, ...
SVDAG_HD inline Ray secondary_ray(const Workload& work, int kind, const Surfel& surfel,
                                  uint64_t pixel, uint32_t i) {
  const uint32_t n = work.secondary.samples;
  if (kind == kShadowRays) return shadow_ray(surfel, work.light);
  return kind == kSoftRays ? soft_ray(surfel, work.light, pixel, i, n)
                           : occlusion_ray(surfel, pixel, i, n);
}

// ... its span and its cut.
SVDAG_HD inline Span secondary_span(const Workload& work, int kind) {
  return {0, kind == kOcclusionRays ? work.secondary.reach : 1};
}
SVDAG_HD inline Cut secondary_cut(const Workload& work, int kind) {
  return kind == kOcclusionRays ? work.secondary.cut : Cut{};
}

SVDAG_HD inline uint32_t rays_per_pixel(const Workload& work, int kind) {
  return kind == kSoftRays || kind == kOcclusionRays ? work.secondary.samples : 1;
}

}  // namespace svdag
