#include "verify/trace/judge/voxel_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/float_rounding.h"

namespace svdag {
namespace {

double distance_to_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from, w = point - from;
  const double square = dot(along, along);
  const double share = square > 0 ? std::clamp(dot(w, along) / square, 0.0, 1.0) : 0;
  return length(w - along * share);
}

}  // namespace

VoxelTriangle in_voxels(const LatticeTriangle& triangle, int fraction) {
  VoxelTriangle result;
  for (int i = 0; i < 3; ++i) {
    for (int a = 0; a < 3; ++a)
      result.v[i][a] = std::ldexp(double(triangle.v[size_t(i)][a]), -fraction);
  }
  return result;
}

Crossing cross_plane(const Ray& ray, const VoxelTriangle& triangle) {
  const Vec3& d = ray.direction;
  const double speed = length(d);
  const double near = dot(triangle.v[0] - ray.origin, d) / (speed * speed);
  const Vec3 origin = ray.origin + d * near;
  Vec3 w[3];
  for (int i = 0; i < 3; ++i) w[i] = triangle.v[i] - origin;
  const Vec3 normal = cross(w[1] - w[0], w[2] - w[0]);
  const double facing = dot(normal, d);
  Crossing result;
  if (facing == 0) return result;
  result.found = true;
  result.t = near + dot(w[0], normal) / facing;
  result.cosine = std::abs(facing) / (length(normal) * speed);
  result.inside = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Vec3 &from = w[i], &to = w[(i + 1) % 3];
    const double spread = length(cross(d, to - from));  // 0: the edge is parallel to the ray
    if (spread == 0) continue;
    const double volume = dot(d, cross(from, to));
    result.inside = std::min(result.inside, (facing < 0 ? -volume : volume) / spread);
  }
  return result;
}

bool is_surely_opaque(const CutOut& cut, const TextureCorners& texture,
                      const VoxelTriangle& triangle, const Vec3& point, double doubt) {
  const Vec3 e1 = triangle.v[1] - triangle.v[0], e2 = triangle.v[2] - triangle.v[0];
  const Vec3 normal = cross(e1, e2), to = point - triangle.v[0];
  const double square = dot(normal, normal);
  if (square == 0) return false;
  const double b = dot(cross(to, e2), normal) / square, c = dot(cross(e1, to), normal) / square;
  // How far a coordinate changes in a voxel, at most.
  const double b_slope = length(e2) / std::sqrt(square), c_slope = length(e1) / std::sqrt(square);
  const auto place = [&](double TexturePoint::*axis, double* half) {
    const double first = texture[0].*axis, by_b = texture[1].*axis - first,
                 by_c = texture[2].*axis - first;
    *half = doubt * (std::abs(by_b) * b_slope + std::abs(by_c) * c_slope);
    return first + b * by_b + c * by_c;
  };
  double half_u, half_v;
  const TexturePoint at = {place(&TexturePoint::u, &half_u), place(&TexturePoint::v, &half_v)};
  OpacityMap::Blocks blocks;
  return opacity_near(cut, at, half_u, half_v, &blocks) == Opacity::kOpaque;
}

Ray float_ray(const Ray& ray, const Vec3& middle) {
  const Vec3 direction = normalized(ray.direction);
  Ray result;
  for (int a = 0; a < 3; ++a) {
    result.origin[a] = middle[a] + round_to_float(ray.origin[a] - middle[a]);
    result.direction[a] = round_to_float(direction[a]);
  }
  return result;
}

double distance(const Vec3& point, const VoxelTriangle& triangle) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i)
    nearest = std::min(nearest, distance_to_segment(point, triangle.v[i], triangle.v[(i + 1) % 3]));
  // If the point projects into the triangle, the plane is nearer than the edges.
  const Vec3 normal = cross(triangle.v[1] - triangle.v[0], triangle.v[2] - triangle.v[0]);
  const double size = length(normal);
  if (size == 0) return nearest;
  const Crossing crossing = cross_plane({point, normal * (1 / size)}, triangle);
  if (crossing.found && crossing.inside >= 0) nearest = std::min(nearest, std::abs(crossing.t));
  return nearest;
}

}  // namespace svdag
