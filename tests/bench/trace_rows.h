// The rays of `make bench-trace`, the same for the DAG and for the triangles.
#pragma once

#include <string>
#include <vector>

#include "io/dag/dag_file.h"
#include "tests/bench/peers/embree.h"
#include "verify/trace/kernel/workload.h"

namespace svdag::bench {

// The rays of one workload. `any`: any hit within the span counts; else the closest hit is found.
struct RayBatch {
  std::string name;
  bool any = false;
  Span span{0, 0x1p100};  // the same for every ray
  std::vector<Ray> rays;
  std::vector<FloatRay> float_rays;  // exactly the same rays, relative to `middle`

  // Adds `ray`, rounded to floats.
  void add(const Ray& ray, const Vec3& middle);
};

// The cameras and lights of the workloads.
struct ViewConfig {
  std::vector<Camera> cameras;  // in voxels
  uint32_t width = 240, height = 136;
  Vec3 light;                       // in voxels
  std::vector<double> light_radii;  // in voxels
  std::vector<double> reaches;      // lengths of ambient occlusion rays, in voxels
  uint32_t samples = 64;            // soft and ao: rays per pixel, for every 32nd pixel
};

// Primary rays in tiles of 8 x 8 pixels, and shadow, soft and ao rays from their hits.
std::vector<RayBatch> make_batches(const DagView& dag, const ViewConfig& config,
                                   const Vec3& middle);

}  // namespace svdag::bench
