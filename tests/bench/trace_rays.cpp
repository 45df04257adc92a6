#include <cmath>

#include "tests/bench/trace_rows.h"
#include "verify/trace/triangle.h"

namespace svdag::bench {
namespace {

constexpr uint32_t kTileSide = 8;

// Calls visit(x, y) for all pixels, tile by tile: rays that lie together are traced together.
template <class Visit>
void for_tiles(uint32_t width, uint32_t height, const Visit& visit) {
  for (uint32_t ty = 0; ty < height; ty += kTileSide) {
    for (uint32_t tx = 0; tx < width; tx += kTileSide) {
      for (uint32_t y = ty; y < std::min(ty + kTileSide, height); ++y) {
        for (uint32_t x = tx; x < std::min(tx + kTileSide, width); ++x) visit(x, y);
      }
    }
  }
}

}  // namespace

void RayBatch::add(const Ray& ray, double end, const Vec3& middle) {
  const Ray rounded = float_ray(ray, middle);
  FloatRay f;
  for (int a = 0; a < 3; ++a) {
    f.origin[a] = float(rounded.origin[a] - middle[a]);
    f.direction[a] = float(rounded.direction[a]);
  }
  f.end = float(end);
  rays.push_back(rounded);
  float_rays.push_back(f);
}

std::vector<RayBatch> make_batches(const DagView& dag, const ViewConfig& config,
                                   const Vec3& middle) {
  std::vector<RayBatch> batches = {{"primary", false, {}, {}}, {"hard shadow", true, {}, {}}};
  const size_t first_soft = batches.size();
  for (size_t i = 0; i < config.light_radii.size(); ++i)
    batches.push_back({"soft shadow " + std::to_string(i), true, {}, {}});
  const size_t first_ao = batches.size();
  for (size_t i = 0; i < config.reaches.size(); ++i)
    batches.push_back({"ao " + std::to_string(i), true, {}, {}});

  for (const Camera& camera : config.cameras) {
    const Picture picture{camera, config.width, config.height};
    for_tiles(config.width, config.height, [&](uint32_t x, uint32_t y) {
      const Ray ray = picture.ray(x, y);
      batches[0].add(ray, 1e30, middle);
      const Surfel surfel = make_surfel(dag, ray, trace_closest(dag, ray));
      if (!surfel.found) return;
      const auto add_to = [&](size_t batch, const Ray& to_light) {
        batches[batch].add(to_light, length(to_light.direction), middle);
      };
      add_to(1, shadow_ray(surfel, {config.light, 0}));
      if (x % 4 != 0 || y % 4 != 0) return;
      const uint64_t pixel = uint64_t(y) * config.width + x;
      for (uint32_t k = 0; k < config.samples; ++k) {
        for (size_t i = 0; i < config.light_radii.size(); ++i)
          add_to(first_soft + i,
                 soft_ray(surfel, {config.light, config.light_radii[i]}, pixel, k, config.samples));
        for (size_t i = 0; i < config.reaches.size(); ++i)
          batches[first_ao + i].add(occlusion_ray(surfel, pixel, k, config.samples),
                                    config.reaches[i], middle);
      }
    });
  }
  return batches;
}

}  // namespace svdag::bench
