// The set voxel nearest to a point: branch and bound down the DAG, the nearest child first.
//
// The distance is that to the closed cube of the voxel, 0 inside. Of voxels at the same distance
// the result is the first in Morton order (depth first, children 4x + 2y + z), so it depends on the
// voxels and the point only, not on the layout.
//
// Exact: the point is snapped once to multiples of 2^-23 voxel, and squares of distances are
// integers of 128 bits. A voxel within kNear voxels is found with 64 bits: a larger offset on one
// axis counts as the largest square there. Rejected: doubles, which are no faster and let rounding
// order voxels whose distances differ by less than an ulp.
//
// Invariant: a cube is skipped only if it is farther than the best voxel so far, or as far and
// after it in Morton order. On each axis a child has the offset of its parent if it is in the
// nearer half, else the distance to the middle plane: three products per node serve all children.
#pragma once

#include <algorithm>
#include <cmath>

#include "io/dag/dag_view.h"

namespace svdag {

constexpr int kNearestBits = 23;                  // of the fraction of a voxel
constexpr int64_t kNear = 256;                    // voxels
constexpr double kFarthestPoint = 68719476736.0;  // voxels on an axis: 2^36
using NearestSquare = unsigned __int128;          // of units of 2^-23 voxel
constexpr NearestSquare kNoLimit = ~NearestSquare(0);

struct NearestSetVoxel {
  bool found = false;
  uint32_t voxel[3] = {};
  NearestSquare square = kNoLimit;  // of the distance

  // In voxels.
  double distance() const noexcept { return std::sqrt(double(square)) / (1 << kNearestBits); }
};

// Whether voxel a comes before voxel b in Morton order.
inline bool before_in_morton_order(const uint32_t (&a)[3], const uint32_t (&b)[3]) noexcept {
  uint32_t most = 0;
  int axis = 0;  // of the highest bit that differs, x before y before z
  for (int i = 0; i < 3; ++i) {
    const uint32_t differ = a[i] ^ b[i];
    if (most < differ && most < (most ^ differ)) most = differ, axis = i;
  }
  return a[axis] < b[axis];
}

// The nodes that hold a point, from the root down; of a point outside of the grid, the root.
struct NearestPath {
  uint32_t nodes[kMaxSections] = {};
  uint32_t deepest = 0;  // level of the last one
};

// The child of the path's node of `level` that holds the point.
inline uint32_t path_octant(const DagView& dag, uint32_t level,
                            const int64_t (&point)[3]) noexcept {
  const uint32_t shift = uint32_t(kNearestBits) + dag.levels - 1 - level;
  return uint32_t((point[0] >> shift & 1) << 2 | (point[1] >> shift & 1) << 1 |
                  (point[2] >> shift & 1));
}

// The paths of up to 32 points, level by level: while the nodes of one are fetched from memory, the
// others go on.
inline void find_paths(const DagView& dag, const int64_t (*points)[3], size_t count,
                       NearestPath* paths) noexcept {
  uint32_t active = 0;  // points
  const int64_t end = int64_t(dag.resolution()) << kNearestBits;
  for (size_t i = 0; i < count; ++i) {
    paths[i].deepest = 0;
    paths[i].nodes[0] = 0;
    const auto& [x, y, z] = points[i];
    if (std::min({x, y, z}) >= 0 && std::max({x, y, z}) < end && !dag.empty()) active |= 1U << i;
  }
  for (uint32_t level = 0; level < dag.brick_level(); ++level)
    for (uint32_t left = active; left != 0; left &= left - 1) {
      const uint32_t i = uint32_t(__builtin_ctz(left));
      NearestPath& path = paths[i];
      const uint32_t child =
          dag_child(dag, level, path.nodes[level], path_octant(dag, level, points[i]));
      if (child == kNoChild) {
        active &= ~(1U << i);
        continue;
      }
      path.nodes[path.deepest = level + 1] = child;
      if (level + 1 == dag.brick_level())
        __builtin_prefetch(dag.bricks + child);
      else if (dag.layout == Layout::kPlain)
        __builtin_prefetch(dag.words[level + 1] + child);
      else
        __builtin_prefetch(dag.compact[level + 1].lines + uint64_t(child / kLineNodes) * 8);
    }
}

// A search with squares of type `Square`: NearestSquare, or uint64_t, which finds only what is less
// than kNear voxels away.
template <class Square>
class NearestSearch {
 public:
  static constexpr Square kLargest = sizeof(Square) == 8 ? Square(1) << 62 : ~Square(0) >> 2;

  // `point`: in units. `limit`: of the square, inclusive, less than kLargest.
  NearestSearch(const DagView& dag, const int64_t (&point)[3], Square limit) noexcept
      : dag_(dag), point_{point[0], point[1], point[2]}, best_(limit) {}

  bool run(const NearestPath& path, NearestSetVoxel* nearest) noexcept {
    if (dag_.empty()) return false;
    for (uint32_t level = path.deepest + 1; level-- > 0;) {
      const uint32_t done = level == path.deepest ? 0 : 1U << path_octant(dag_, level, point_);
      search(level, path.nodes[level], done);
      if (level > 0 && is_within(level)) break;
    }
    if (!found_) return false;
    *nearest = {true, {voxel_[0], voxel_[1], voxel_[2]}, best_};
    return true;
  }

 private:
  struct Cube {
    Square square;      // of the distance
    Square offsets[3];  // their squares
    uint32_t index;     // of the node
    uint32_t level;
    uint32_t corner[3];
  };
  // The children of a cube. Child c is in the farther half on the axes of c ^ nearer.
  struct Halves {
    Square offsets[3][2];  // of the nearer and of the farther half
    uint32_t nearer = 0;   // the nearest child
    Square square(uint32_t far) const noexcept {
      return offsets[0][far >> 2] + offsets[1][far >> 1 & 1] + offsets[2][far & 1];
    }
    // Those of the children in `mask` that are not farther than `best`, as a mask of c ^ nearer.
    uint32_t within(Square best, uint32_t mask) const noexcept {
      uint32_t near = 0;
      for (uint32_t far = 0; far < 8; ++far) near |= uint32_t(square(far) <= best) << far;
      if (nearer & 4) mask = (mask >> 4 & 0x0f) | (mask << 4 & 0xf0);
      if (nearer & 2) mask = (mask >> 2 & 0x33) | (mask << 2 & 0xcc);
      if (nearer & 1) mask = (mask >> 1 & 0x55) | (mask << 1 & 0xaa);
      return near & mask;
    }
  };
  struct Child {
    Square square;
    uint32_t number;
  };
  struct Children {
    Child list[8];
    int count = 0;
    // Keeps the list in descending order of distance, then number.
    void add(const Child& child) noexcept {
      int at = count++;
      for (; at > 0 && list[at - 1].square <= child.square; --at) list[at] = list[at - 1];
      list[at] = child;
    }
  };

  static Square square(int64_t offset) noexcept {
    if (sizeof(Square) == 8 && offset >= kNear << kNearestBits) return kLargest;
    return Square(offset) * Square(offset);
  }
  bool can_hold_nearer(Square square, const uint32_t (&corner)[3]) const noexcept {
    return square < best_ ||
           (square == best_ && (!found_ || before_in_morton_order(corner, voxel_)));
  }

  // Whether all that is as near as the best is in the path's node of `level`.
  bool is_within(uint32_t level) const noexcept {
    const int64_t side = int64_t(1) << (uint32_t(kNearestBits) + dag_.levels - level);
    int64_t gap = side;
    for (const int64_t p : point_) {
      const int64_t low = p & (side - 1);
      gap = std::min({gap, low, side - low});
    }
    return square(gap) > best_;
  }

  // The cubes below the path's node of `level`, without the children in `except`.
  void search(uint32_t level, uint32_t index, uint32_t except) noexcept {
    Cube cube{0, {}, index, level, {}};
    const int64_t side = int64_t(1) << (dag_.levels - level);
    for (int a = 0; a < 3; ++a) {
      const int64_t low = level == 0 ? 0 : (point_[a] >> kNearestBits) & -side;
      const int64_t below = low * kUnit - point_[a], above = -below - side * kUnit;
      cube.corner[a] = uint32_t(low);
      cube.offsets[a] = square(std::max({below, above, int64_t(0)}));
      cube.square += cube.offsets[a];
    }
    if (!can_hold_nearer(cube.square, cube.corner)) return;
    size_ = 0;
    expand(cube, except);
    while (size_ > 0) {
      const Cube next = stack_[--size_];
      if (can_hold_nearer(next.square, next.corner)) expand(next, 0);
    }
  }

  Halves halves_of(const uint32_t (&corner)[3], const Square (&offsets)[3],
                   uint32_t half) const noexcept {
    Halves halves;
    for (int a = 0; a < 3; ++a) {
      const int64_t above = point_[a] - (int64_t(corner[a] + half) << kNearestBits);
      halves.offsets[a][0] = offsets[a];
      halves.offsets[a][1] = square(above < 0 ? -above : above);
      halves.nearer = halves.nearer << 1 | uint32_t(above > 0);
    }
    return halves;
  }

  void expand(const Cube& cube, uint32_t except) noexcept {
    if (cube.level == dag_.brick_level()) return search_brick(cube);
    const uint32_t half = 1U << (dag_.levels - 1 - cube.level);
    const Halves halves = halves_of(cube.corner, cube.offsets, half);
    Children children;
    const uint32_t mask = dag_mask(dag_, cube.level, cube.index) & ~except;
    for (uint32_t near = halves.within(best_, mask); near != 0; near &= near - 1) {
      const uint32_t far = uint32_t(__builtin_ctz(near));
      children.add({halves.square(far), far ^ halves.nearer});
    }
    for (int i = 0; i < children.count; ++i) {
      const Child& child = children.list[i];
      const uint32_t c = child.number, far = c ^ halves.nearer;
      stack_[size_++] = {child.square,
                         {halves.offsets[0][far >> 2], halves.offsets[1][far >> 1 & 1],
                          halves.offsets[2][far & 1]},
                         dag_present_child(dag_, cube.level, cube.index, c),
                         cube.level + 1,
                         {cube.corner[0] + (c >> 2) * half, cube.corner[1] + (c >> 1 & 1) * half,
                          cube.corner[2] + (c & 1) * half}};
    }
  }

  void search_brick(const Cube& cube) noexcept {
    const uint64_t brick = dag_.bricks[cube.index];
    const Halves halves = halves_of(cube.corner, cube.offsets, 2);
    Children octants;
    uint32_t mask = 0;
    for (uint32_t c = 0; c < 8; ++c) mask |= uint32_t((brick >> 8 * c & 0xff) != 0) << c;
    for (uint32_t near = halves.within(best_, mask); near != 0; near &= near - 1) {
      const uint32_t far = uint32_t(__builtin_ctz(near));
      octants.add({halves.square(far), far ^ halves.nearer});
    }
    while (octants.count > 0) {
      const Child& octant = octants.list[--octants.count];
      const uint32_t c = octant.number, far = c ^ halves.nearer;
      const uint32_t corner[3] = {cube.corner[0] + (c >> 2) * 2, cube.corner[1] + (c >> 1 & 1) * 2,
                                  cube.corner[2] + (c & 1) * 2};
      const Square offsets[3] = {halves.offsets[0][far >> 2], halves.offsets[1][far >> 1 & 1],
                                 halves.offsets[2][far & 1]};
      if (can_hold_nearer(octant.square, corner))
        search_octant(corner, offsets, uint32_t(brick >> 8 * c & 0xff));
    }
  }

  void search_octant(const uint32_t (&corner)[3], const Square (&offsets)[3],
                     uint32_t voxels) noexcept {
    const Halves halves = halves_of(corner, offsets, 1);
    uint32_t nearest = 0;
    Square square = kLargest;
    for (uint32_t near = halves.within(best_, voxels); near != 0; near &= near - 1) {
      const uint32_t far = uint32_t(__builtin_ctz(near)), c = far ^ halves.nearer;
      const Square of_voxel = halves.square(far);
      if (of_voxel < square || (of_voxel == square && c < nearest)) square = of_voxel, nearest = c;
      if (far == 0) break;
    }
    if (square == kLargest) return;
    const uint32_t voxel[3] = {corner[0] + (nearest >> 2), corner[1] + (nearest >> 1 & 1),
                               corner[2] + (nearest & 1)};
    if (!can_hold_nearer(square, voxel)) return;
    found_ = true;
    best_ = square;
    std::copy(voxel, voxel + 3, voxel_);
  }

  static constexpr int64_t kUnit = int64_t(1) << kNearestBits;

  const DagView& dag_;
  const int64_t point_[3];
  Square best_;  // of the voxel found, or the limit
  bool found_ = false;
  uint32_t voxel_[3] = {};
  Cube stack_[8 * kMaxSections];
  size_t size_ = 0;
};

// The voxel nearest to `point`, in units and less than kFarthestPoint, if the square of its
// distance is at most `limit`. `path`: that of the point.
inline NearestSetVoxel nearest_voxel(const DagView& dag, const int64_t (&point)[3],
                                     const NearestPath& path, NearestSquare limit) noexcept {
  NearestSetVoxel nearest;
  using Near = NearestSearch<uint64_t>;
  using Far = NearestSearch<NearestSquare>;
  const auto near_limit = uint64_t(std::min<NearestSquare>(limit, Near::kLargest - 1));
  if (!Near(dag, point, near_limit).run(path, &nearest) && limit >= Near::kLargest)
    Far(dag, point, std::min(limit, Far::kLargest - 1)).run(path, &nearest);
  return nearest;
}
inline NearestSetVoxel nearest_voxel(const DagView& dag, const int64_t (&point)[3],
                                     NearestSquare limit = kNoLimit) noexcept {
  NearestPath path;
  find_paths(dag, &point, 1, &path);
  return nearest_voxel(dag, point, path, limit);
}

// Snaps a point of the world to units. False if it is not finite, or kFarthestPoint voxels away.
inline bool snap_for_nearest(const DagView& dag, const double (&world)[3],
                             int64_t (&point)[3]) noexcept {
  for (int a = 0; a < 3; ++a) {
    const double voxels = voxel_from_world(dag, a, world[a]);
    if (!(std::abs(voxels) < kFarthestPoint)) return false;
    point[a] = int64_t(std::nearbyint(voxels * (1 << kNearestBits)));
  }
  return true;
}

// The voxel nearest to `point`, in units, and *distance in world units, which is at most
// `max_distance` if a voxel is found.
inline NearestSetVoxel nearest_within(const DagView& dag, const int64_t (&point)[3],
                                      const NearestPath& path, double max_distance,
                                      double* distance) noexcept {
  // A limit that is not too small: the rounded distance decides.
  const double units = max_distance / dag.voxel_size * (1 << kNearestBits);
  const double square = units * units * (1 + 1e-9) + 1;
  const NearestSetVoxel nearest =
      nearest_voxel(dag, point, path, square < 1e37 ? NearestSquare(square) : kNoLimit);
  *distance = nearest.distance() * dag.voxel_size;
  return nearest.found && *distance <= max_distance ? nearest : NearestSetVoxel{};
}

// The same for a point of the world.
inline NearestSetVoxel nearest_in_world(const DagView& dag, const double (&world)[3],
                                        double max_distance, double* distance) noexcept {
  int64_t point[3];
  if (!snap_for_nearest(dag, world, point)) return {};
  NearestPath path;
  find_paths(dag, &point, 1, &path);
  return nearest_within(dag, point, path, max_distance, distance);
}

}  // namespace svdag
