// Defines a ray, the times at which it crosses planes, and a hit: shared by all traversals.
//
// Coordinates are in voxels. A ray is mirrored so that its direction is positive on all axes: axis
// a is flipped (x -> N - x) where the direction is negative. The planes x = i, y = j, z = k cut it
// at the times
//
//   time(a, i) = (i - origin[a]) * inverse[a]      in double: one subtraction, one multiplication
//
// and only these define its position: at time t it is in the cell of the last planes that it has
// passed (time <= t). A cube is entered at enter = max(begin, its three near planes), left at
// exit = min(end, its three far planes), and met if enter < exit. The hit is the solid cube met
// first. So the hit depends on ray and voxels only, not on the traversal: all of them (plain, fast,
// vectorized, on a GPU) give the same bits.
//
// Exactness: planes are integers and times are never accumulated, so errors do not add up: at 1M^3
// positions are exact to within 2^-32 voxel. Rounding is monotone, so times ascend with their
// planes; no cell is skipped and none is visited twice. Rejected: floats in [1, 2) (23 bits are too
// few beyond 8K^3); adding increments (they drift); i * inverse - origin * inverse (cancellation,
// and not faster without fused operations, which differ between machines).
//
// Depends only on dag_view.h, for host and CUDA.
#pragma once

#include "io/dag/dag_view.h"

namespace svdag {

// Correctly rounded, like + - * /, so host and device compute the same bits.
SVDAG_HD inline double square_root(double v) {
#if defined(__CUDA_ARCH__)
  return __dsqrt_rn(v);
#else
  return __builtin_sqrt(v);
#endif
}

// v must not be 0.
SVDAG_HD inline uint32_t highest_bit(uint32_t v) {
#if defined(__CUDA_ARCH__)
  return 31U - uint32_t(__clz(int(v)));
#else
  return 31U - uint32_t(__builtin_clz(v));
#endif
}

struct Vec3 {
  double v[3];
  SVDAG_HD double operator[](int a) const { return v[a]; }
  SVDAG_HD double& operator[](int a) { return v[a]; }
};

struct Ray {
  Vec3 origin;     // in voxels
  Vec3 direction;  // length 1e-100 to 1e100, the unit of t
};

// The ray of world coordinates; t is in units of the length of `direction`.
SVDAG_HD inline Ray ray_from_world(const DagView& dag, const Vec3& origin, const Vec3& direction) {
  Ray ray;
  for (int a = 0; a < 3; ++a) {
    ray.origin[a] = voxel_from_world(dag, a, origin[a]);
    ray.direction[a] = direction[a] / dag.voxel_size;
  }
  return ray;
}

// The part of a ray that is traced: begin <= t < end.
struct Span {
  double begin = 0;  // not negative
  double end = 1e300;
};

// Which cubes count as solid although they are larger than a voxel.
struct Cut {
  uint32_t level = 0xffffffffU;  // cubes of this level are solid; default: only voxels
  // Width of a cone around the ray per unit of length (2 * tangent of half its angle); 0: no cone.
  // A cube is solid if its side is at most spread * t * |direction| at the t where it is entered.
  double spread = 0;

  SVDAG_HD bool cuts(uint32_t levels) const { return level < levels || spread > 0; }
};

struct Hit {
  bool found = false;
  double t = 0;            // where the ray enters the cube (begin if it starts inside)
  uint32_t voxel[3] = {};  // the cube's corner; the voxel itself unless the ray was cut
  uint32_t level = 0;      // of the cube; the DAG's `levels` for a voxel
  int axis = 0;            // normal of the face through which the cube is entered
  uint32_t steps = 0;      // steps of the traversal, for pictures of the work; not part of the
                           // result: traversals differ in it
};

// Components of the direction smaller than this fraction of the largest are replaced by it. Over
// the diagonal of 1M^3 voxels this moves the ray by 2^-40 voxel, and no time is infinite.
constexpr double kTinySlope = 0x1p-61;

// A ray in mirrored coordinates.
struct MirroredRay {
  double origin[3];
  double slope[3];    // the direction, positive
  double inverse[3];  // 1 / slope
  unsigned flip = 0;  // flipped axes, as a child number (4x + 2y + z)

  MirroredRay() = default;
  SVDAG_HD MirroredRay(const Ray& ray, uint32_t resolution) {
    double largest = 0;
    for (int a = 0; a < 3; ++a) {
      const double size = ray.direction[a] < 0 ? -ray.direction[a] : ray.direction[a];
      largest = size > largest ? size : largest;
    }
    for (int a = 0; a < 3; ++a) {
      const bool backward = ray.direction[a] < 0;
      const double size = backward ? -ray.direction[a] : ray.direction[a];
      const double tiny = kTinySlope * largest;
      slope[a] = size < tiny ? tiny : size;
      inverse[a] = 1 / slope[a];
      origin[a] = backward ? double(resolution) - ray.origin[a] : ray.origin[a];
      flip |= unsigned(backward) << (2 - a);
    }
  }

  SVDAG_HD double time(int axis, uint32_t plane) const {
    return (double(plane) - origin[axis]) * inverse[axis];
  }

  // Clips `span` to the grid; false if nothing is left.
  SVDAG_HD bool clip(uint32_t resolution, Span* span) const {
    for (int a = 0; a < 3; ++a) {
      const double in = time(a, 0), out = time(a, resolution);
      span->begin = in > span->begin ? in : span->begin;
      span->end = out < span->end ? out : span->end;
    }
    return span->begin < span->end;
  }

  // The hit on the cube of side 2^(levels - level) at `corner`, entered at t.
  SVDAG_HD Hit hit(uint32_t levels, uint32_t level, const uint32_t corner[3], double t) const {
    Hit hit;
    hit.found = true;
    hit.t = t;
    hit.level = level;
    double last = 0;
    for (int a = 0; a < 3; ++a) {
      const bool flipped = flip >> (2 - a) & 1U;
      hit.voxel[a] = flipped ? (1U << levels) - (1U << (levels - level)) - corner[a] : corner[a];
      const double near = time(a, corner[a]);
      if (a == 0 || near > last) {
        last = near;
        hit.axis = a;
      }
    }
    return hit;
  }
};

// A Cut for one ray: in times instead of lengths.
struct CutOfRay {
  uint32_t level;  // cubes of this level are solid
  double widen;    // and cubes of side <= widen * (time of entry)

  SVDAG_HD CutOfRay(const Cut& cut, const Ray& ray, uint32_t levels)
      : level(cut.level < levels ? cut.level : levels), widen(0) {
    if (!(cut.spread > 0)) return;
    double square = 0;
    for (int a = 0; a < 3; ++a) square += ray.direction[a] * ray.direction[a];
    widen = cut.spread * square_root(square);
  }

  SVDAG_HD bool solid(uint32_t at_level, double side, double t) const {
    return at_level >= level || side <= widen * t;
  }
};

}  // namespace svdag
