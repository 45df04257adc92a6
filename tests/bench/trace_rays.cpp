#include <cmath>

#include "io/float_rounding.h"
#include "tests/bench/trace_rows.h"
#include "verify/trace/kernel/beam.h"

namespace svdag::bench {
namespace {

// Calls visit(x, y) for all pixels, tile by tile, so that neighbouring rays are traced together.
template <class Visit>
void for_tiles(uint32_t width, uint32_t height, const Visit& visit) {
  for (uint32_t ty = 0; ty < height; ty += kTile) {
    for (uint32_t tx = 0; tx < width; tx += kTile) {
      for (uint32_t y = ty; y < std::min(ty + kTile, height); ++y) {
        for (uint32_t x = tx; x < std::min(tx + kTile, width); ++x) visit(x, y);
      }
    }
  }
}

}  // namespace

void RayBatch::add(const Ray& ray, const Vec3& middle) {
  Ray rounded;
  FloatRay f;
  for (int a = 0; a < 3; ++a) {
    const double from = round_to_float(ray.origin[a] - middle[a]);
    rounded.origin[a] = middle[a] + from;
    rounded.direction[a] = round_to_float(ray.direction[a]);
    f.origin[a] = float(from);
    f.direction[a] = float(rounded.direction[a]);
  }
  f.end = float(span.end);
  rays.push_back(rounded);
  float_rays.push_back(f);
}

std::vector<RayBatch> make_batches(const DagView& dag, const ViewConfig& config,
                                   const Vec3& middle) {
  const Span to_light{0, 1};
  std::vector<RayBatch> batches = {{"primary", false, {0, 0x1p100}, {}, {}},
                                   {"hard shadow", true, to_light, {}, {}}};
  const size_t first_soft = batches.size();
  for (size_t i = 0; i < config.light_radii.size(); ++i)
    batches.push_back({"soft shadow " + std::to_string(i), true, to_light, {}, {}});
  const size_t first_ao = batches.size();
  for (size_t i = 0; i < config.reaches.size(); ++i) {
    const double reach = round_to_float(config.reaches[i]);
    batches.push_back({"ao " + std::to_string(i), true, {0, reach}, {}, {}});
  }

  for (const Camera& camera : config.cameras) {
    const Picture picture{camera, config.width, config.height};
    for_tiles(config.width, config.height, [&](uint32_t x, uint32_t y) {
      const Ray ray = picture.ray(x, y);
      batches[0].add(ray, middle);
      const Surfel surfel = make_surfel(dag, ray, trace_closest(dag, ray));
      if (!surfel.found) return;
      batches[1].add(shadow_ray(surfel, {config.light, 0}), middle);
      if (x % 8 != 0 || y % 4 != 0) return;
      const uint64_t pixel = uint64_t(y) * config.width + x;
      for (uint32_t k = 0; k < config.samples; ++k) {
        for (size_t i = 0; i < config.light_radii.size(); ++i)
          batches[first_soft + i].add(
              soft_ray(surfel, {config.light, config.light_radii[i]}, pixel, k, config.samples),
              middle);
        for (size_t i = 0; i < config.reaches.size(); ++i)
          batches[first_ao + i].add(occlusion_ray(surfel, pixel, k, config.samples), middle);
      }
    });
  }
  return batches;
}

}  // namespace svdag::bench
