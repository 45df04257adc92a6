// The rays of `make bench-trace`: the same for the DAG and for the triangles.
#pragma once

#include <string>
#include <vector>

#include "io/dag/dag_file.h"
#include "tests/bench/peers/embree.h"
#include "verify/trace/kernel/workload.h"

namespace svdag::bench {

// Of one workload: `any` tests whether anything is hit before the end, else finds the closest hit.
struct RayBatch {
  std::string name;
  bool any = false;
  Span span{0, 0x1p100};  // of every ray
  std::vector<Ray> rays;
  std::vector<FloatRay> float_rays;  // the same rays, bit by bit, relative to the middle

  // Adds the ray nearest to `ray` that floats hold.
  void add(const Ray& ray, const Vec3& middle);
};

// All lengths in units of the world.
struct ViewConfig {
  std::vector<Camera> cameras;  // in voxels
  uint32_t width = 240, height = 136;
  Vec3 light;                       // in voxels
  std::vector<double> light_radii;  // in voxels
  std::vector<double> reaches;      // of ambient occlusion, in voxels
  uint32_t samples = 64;            // soft and ao: rays of one pixel, of every 32nd pixel
};

// Primary rays in tiles of 8 x 8 pixels; from what they show shadow, soft and ao rays.
std::vector<RayBatch> make_batches(const DagView& dag, const ViewConfig& config,
                                   const Vec3& middle);

}  // namespace svdag::bench
