#include "verify/trace/difference_picture.h"

#include "streaming/error.h"
#include "verify/trace/kernel/traverse.h"

namespace svdag {
namespace {

const Vec3 kBoth{{1, 1, 1}}, kOnlyA{{2.2, 0.25, 0.2}}, kOnlyB{{0.25, 0.6, 2.4}};

Vec3 colour_of(const DagView& a, const DagView& b, const Shading& shading, const Ray& ray) {
  const Hit in_a = trace_closest(a, ray), in_b = trace_closest(b, ray);
  if (!in_a.found && !in_b.found) return shade(shading, ray, in_a, {}, 1);
  const bool only_a = in_a.found && (!in_b.found || in_a.t < in_b.t);
  const bool only_b = in_b.found && (!in_a.found || in_b.t < in_a.t);
  const DagView& shown = only_b ? b : a;
  const Hit& hit = only_b ? in_b : in_a;
  const Vec3 light = shade(shading, ray, hit, make_surfel(shown, ray, hit), 1);
  const Vec3& tint = only_a ? kOnlyA : only_b ? kOnlyB : kBoth;
  return {{light[0] * tint[0], light[1] * tint[1], light[2] * tint[2]}};
}

}  // namespace

Image render_difference(const DagView& a, const DagView& b, const Camera& camera,
                        const Shading& shading, const RenderConfig& config, Executor& executor,
                        Progress& progress) {
  SVDAG_ASSERT(a.levels == b.levels);
  Image image(config.width, config.height);
  const int n = config.supersample;
  progress.phase("rendering", size_t(config.height));
  executor.for_each(size_t(config.height), [&](size_t, size_t row) {
    for (int x = 0; x < config.width; ++x) {
      Vec3 sum{};
      for (int i = 0; i < n * n; ++i) {
        const double u = (x + (i % n + 0.5) / n) / config.width;
        const double v = (double(row) + (i / n + 0.5) / n) / config.height;
        sum = sum + colour_of(a, b, shading, camera.ray(u, v));
      }
      image.set(x, int(row), sum * (1.0 / (n * n)));
    }
    progress.advance();
  });
  return image;
}

}  // namespace svdag
