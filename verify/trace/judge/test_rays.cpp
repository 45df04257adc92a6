#include "verify/trace/judge/test_rays.h"

#include <algorithm>
#include <cmath>

#include "verify/trace/kernel/sampling.h"

namespace svdag {
namespace {

constexpr int kUp = 1;  // of the camera; any axis would do
constexpr Vec3 kTowards{{-0.6, -0.5, -0.7}};

Vec3 random_direction(RayRandom& random) {
  const double z = 2 * random.unit() - 1, angle = 2 * kPi * random.unit();
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {{r * std::cos(angle), r * std::sin(angle), z}};
}

Vec3 random_point(const VoxelBounds& box, RayRandom& random) {
  Vec3 point;
  for (int a = 0; a < 3; ++a) point[a] = box.min[a] + random.unit() * (box.max[a] - box.min[a]);
  return point;
}

}  // namespace

TriangleSampler::TriangleSampler(std::span<const VoxelTriangle> triangles, MemoryBudget* budget)
    : triangles_(triangles),
      reservation_(budget->reserve(triangles.size() * sizeof(double), "areas of triangles")) {
  areas_.reserve(triangles.size());
  double sum = 0;
  for (const VoxelTriangle& t : triangles) {
    const Vec3 normal = cross(t.v[1] - t.v[0], t.v[2] - t.v[0]);
    areas_.push_back(sum += length(normal));
  }
}

TriangleSampler::Sample TriangleSampler::draw(RayRandom& random) const {
  const bool by_area = random.unit() < 0.5;
  const double position = random.unit();
  const auto at = by_area ? std::upper_bound(areas_.begin(), areas_.end(), position * areas_.back())
                          : areas_.begin() + ptrdiff_t(position * double(areas_.size()));
  const size_t index = std::min(size_t(at - areas_.begin()), areas_.size() - 1);
  const VoxelTriangle& t = triangles_[index];
  double u = random.unit(), v = random.unit();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const Vec3 a = t.v[1] - t.v[0], b = t.v[2] - t.v[0], normal = cross(a, b);
  const bool flat = dot(normal, normal) == 0;
  return {t.v[0] + a * u + b * v, flat ? Vec3{{1, 0, 0}} : normalized(normal), uint32_t(index)};
}

TestRays::TestRays(const VoxelBounds& box, const TriangleTracer& tracer,
                   const TriangleSampler& sampler, uint64_t seed)
    : box_(box),
      camera_(frame_box(box, kTowards, kUp, Camera::kDefaultFov, 1)),
      tracer_(tracer),
      sampler_(sampler),
      seed_(seed) {}

Ray TestRays::ray(uint64_t index) const {
  RayRandom random(seed_, index);
  Ray ray;
  switch (kind(index)) {
    case RayKind::kCamera: {
      const double x = random.unit(), y = random.unit();
      ray = camera_.ray(x, y);
      break;
    }
    case RayKind::kChord:
      ray = chord(random);
      break;
    case RayKind::kInside:
      ray = inside(random);
      break;
    case RayKind::kAxis:
      ray = along_axis(random);
      break;
    case RayKind::kSurface:
      ray = sampler_.empty() ? chord(random) : at_surface(random);
      break;
  }
  return float_ray(ray, tracer_.middle());
}

Ray TestRays::chord(RayRandom& random) const {
  const Vec3 middle = (box_.min + box_.max) * 0.5, half = (box_.max - box_.min) * 0.5;
  const double radius = std::max(length(half), 1.0);  // also for a scene that is a point
  const Vec3 from = middle + random_direction(random) * radius;
  const Vec3 to = middle + random_direction(random) * radius;
  return {from, to - from};
}

Ray TestRays::inside(RayRandom& random) const {
  const Vec3 from = random_point(box_, random);
  return {from, random_direction(random)};
}

Ray TestRays::along_axis(RayRandom& random) const {
  const uint64_t choice = random.next();
  const int axis = int(choice % 3);
  const bool forward = choice >> 32 & 1, from_outside = choice >> 33 & 1,
             aimed = choice >> 34 & 1 && !sampler_.empty();
  Ray ray{aimed ? sampler_.draw(random).point : random_point(box_, random), {}};
  for (int a = 0; a < 3; ++a) ray.origin[a] = std::floor(ray.origin[a]) + 0.5;
  if (from_outside)
    ray.origin[axis] = std::floor(forward ? box_.min[axis] : box_.max[axis]) + (forward ? -2 : 2);
  ray.direction[axis] = forward ? 1 : -1;
  return ray;
}

Ray TestRays::at_surface(RayRandom& random) const {
  const TriangleSampler::Sample sample = sampler_.draw(random);
  const uint64_t choice = random.next();
  const Vec3 side = sample.normal * (choice & 1 ? 1 : -1);
  const double x = random.unit(), y = random.unit();
  const Vec3 out = cosine_direction(side, {x, y});
  if (choice >> 1 & 1) return {sample.point + out * 2, out};
  const Vec3 size = box_.max - box_.min;
  const double furthest = std::max(4.0, length(size));
  return {sample.point + out * (2 * std::pow(furthest / 2, random.unit())), out * -1};
}

}  // namespace svdag
