#include "verify/trace/cpu.h"

namespace svdag {

Image render(const DagView& dag, const Camera& camera, const Shading& shading,
             const RenderConfig& config, Executor& executor, Progress& progress) {
  Image image(config.width, config.height);
  const int n = config.supersample;
  const auto pixel = [&](int x, int y) {
    Vec3 sum{};
    for (int i = 0; i < n * n; ++i) {
      const double sx = (i % n + 0.5) / n, sy = (i / n + 0.5) / n;
      const Ray ray = camera.ray((x + sx) / config.width, (y + sy) / config.height);
      sum = sum + shade(shading, dag, ray, trace_closest(dag, ray));
    }
    return sum * (1.0 / (n * n));
  };
  progress.phase("rendering", uint64_t(config.height));
  executor.for_each(size_t(config.height), [&](size_t, size_t y) {
    for (int x = 0; x < config.width; ++x) {
      const Vec3 colour = pixel(x, int(y));
      if (shading.mode == ShadeMode::kPrimary || shading.mode == ShadeMode::kShadow) {
        image.set(x, int(y), colour);
      } else {
        image.set_raw(x, int(y), colour);
      }
    }
    progress.advance();
  });
  progress.finish();
  return image;
}

}  // namespace svdag
