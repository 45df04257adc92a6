// The four measured workloads, on the processor or on a GPU: same rays, same answers.
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
  bool beams = true;     // primary rays start where their tile's beam ends
  uint32_t rounds = 3;   // each is traced so often; the least time counts
  unsigned threads = 0;  // of the processor; 0: all
};

enum WorkloadKind { kPrimaryRays, kShadowRays, kSoftRays, kOcclusionRays, kWorkloads };

constexpr const char* kWorkloadNames[kWorkloads] = {"primary", "shadow", "soft", "ao"};

// Pixel by pixel, row after row.
struct Answers {
  std::string device;     // in words
  std::vector<Hit> hits;  // of the primary rays
  std::vector<Surfel> surfels;
  std::vector<uint32_t> blocked[kWorkloads];  // secondary rays that meet something
  double seconds[kWorkloads] = {};
  uint64_t rays[kWorkloads] = {};
};

// Of a pixel.
constexpr uint64_t kAnswerBytes = sizeof(Hit) + sizeof(Surfel) + 3 * sizeof(uint32_t);

Answers trace_on_cpu(const PlainFile& file, const Workload& work);

// No device, a program without CUDA, or too little memory there is an Error.
Answers trace_on_cuda(const PlainFile& file, const Workload& work);

// Secondary ray i of `kind` from a surfel, ...
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
