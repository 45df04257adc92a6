#include "python/queries.h"

#include <algorithm>
#include <cmath>

#include "io/dag/colours/colour_reader.h"
#include "io/dag/walk/nearest.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/process/interrupt.h"
#include "verify/trace/kernel/processor.h"
#include "verify/trace/kernel/tree64.h"

namespace svdag {
namespace {

constexpr size_t kPointsPerTask = size_t(1) << 16;
constexpr size_t kColoursPerTask = size_t(1) << 13;
constexpr size_t kNearestPerTask = size_t(1) << 12;
constexpr size_t kRaysPerTask = size_t(1) << 14;
constexpr size_t kRaysTogether = 256;  // rays and hits of a thread stay in its cache
constexpr size_t kTogether = 32;  // points that descend together, so that none waits for memory

// Calls visit(begin, end) for successive pieces of 0 .. count, on all threads.
template <class Visit>
void in_pieces(size_t count, size_t piece, Executor* executor, const Visit& visit) {
  executor->for_each((count + piece - 1) / piece, [&](size_t, size_t i) {
    check_interrupt();
    visit(i * piece, std::min(count, (i + 1) * piece));
  });
}

// The same for loops of look-ups, compiled for this processor.
template <class Visit>
void in_fast_pieces(size_t count, size_t piece, Executor* executor, const Visit& visit) {
  in_pieces(count, piece, executor,
            [&](size_t begin, size_t end) { run_fast([&] { visit(begin, end); }); });
}

// Looks up to kTogether voxels up, level by level: while the children of one are fetched from
// memory, the others go on. voxels[i] is outside of the grid if any coordinate is 2^L or more.
void look_up_together(const DagView& dag, const std::array<uint32_t, 3>* voxels, size_t count,
                      uint8_t* set) {
  uint32_t nodes[kTogether] = {};
  for (size_t i = 0; i < count; ++i) {
    const auto& v = voxels[i];
    if (((v[0] | v[1] | v[2]) >> dag.levels) != 0 || dag.empty()) nodes[i] = kNoChild;
  }
  for (uint32_t level = 0; level < dag.brick_level(); ++level) {
    const uint32_t s = dag.levels - 1 - level;
    for (size_t i = 0; i < count; ++i) {
      if (nodes[i] == kNoChild) continue;
      const auto& v = voxels[i];
      const unsigned c = octant_of(v[0], v[1], v[2], s);
      nodes[i] = dag_child(dag, level, nodes[i], c);
      if (nodes[i] == kNoChild) continue;
      if (level + 1 == dag.brick_level())
        __builtin_prefetch(dag.bricks + nodes[i]);
      else if (dag.layout == Layout::kPlain)
        __builtin_prefetch(dag.words[level + 1] + nodes[i]);
      else
        __builtin_prefetch(dag.compact[level + 1].lines + uint64_t(nodes[i] / kLineNodes) * 8);
    }
  }
  for (size_t i = 0; i < count; ++i) {
    const auto& v = voxels[i];
    const unsigned outer = child_index(v[0] >> 1 & 1, v[1] >> 1 & 1, v[2] >> 1 & 1);
    const unsigned inner = child_index(v[0] & 1, v[1] & 1, v[2] & 1);
    set[i] = nodes[i] != kNoChild && (dag.bricks[nodes[i]] >> (8 * outer + inner) & 1) != 0;
  }
}

// The voxel of a point that voxels or the world give; ~0 on an axis: outside.
std::array<uint32_t, 3> voxel_at(const DagView&, const std::array<int64_t, 3>& p) {
  std::array<uint32_t, 3> voxel;
  for (size_t a = 0; a < 3; ++a) voxel[a] = uint64_t(p[a]) > 0xffffffff ? ~0U : uint32_t(p[a]);
  return voxel;
}
std::array<uint32_t, 3> voxel_at(const DagView& dag, const std::array<double, 3>& p) {
  const double side = dag.resolution();
  std::array<uint32_t, 3> voxel;
  for (int a = 0; a < 3; ++a) {
    const double at = voxel_from_world(dag, a, p[size_t(a)]);
    voxel[size_t(a)] = at >= 0 && at < side ? uint32_t(at) : ~0U;  // NaN is outside
  }
  return voxel;
}

template <class Point>
void look_up_all(const DagView& dag, std::span<const Point> points, uint8_t* set,
                 Executor* executor) {
  in_fast_pieces(points.size(), kPointsPerTask, executor, [&](size_t begin, size_t end) {
    std::array<uint32_t, 3> voxels[kTogether];
    for (size_t at = begin; at < end; at += kTogether) {
      const size_t count = std::min(kTogether, end - at);
      for (size_t i = 0; i < count; ++i) voxels[i] = voxel_at(dag, points[at + i]);
      look_up_together(dag, voxels, count, set + at);
    }
  });
}

// Whether the cube of `level` at (x, y, z), in units of its side, has a set voxel.
bool is_covered(const DagView& dag, uint32_t level, const std::array<uint32_t, 3>& at) {
  const auto [x, y, z] = at;
  if (((x | y | z) >> level) != 0 || dag.empty()) return false;
  uint32_t node = 0;
  for (uint32_t k = 0; k < std::min(level, dag.brick_level()); ++k) {
    node = dag_child(dag, k, node, octant_of(x, y, z, level - 1 - k));
    if (node == kNoChild) return false;
  }
  if (level <= dag.brick_level()) return true;
  const uint32_t finer = level - dag.brick_level();  // 1: octants, 2: voxels
  const uint64_t octant = dag.bricks[node] >> 8 * octant_of(x, y, z, finer - 1) & 0xff;
  return finer == 1 ? octant != 0 : (octant >> octant_of(x, y, z, 0) & 1) != 0;
}

void put_colour(uint32_t colour, Rgb* out) {
  if (colour != kNoColour) *out = {uint8_t(colour), uint8_t(colour >> 8), uint8_t(colour >> 16)};
}

template <class Point, class CubeOf>
void look_up_colours_of(const ColourView& colours, uint32_t level, std::span<const Point> points,
                        Rgb* out, Executor* executor, const CubeOf& cube_of) {
  in_fast_pieces(points.size(), kColoursPerTask, executor, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const std::array<uint32_t, 3> cube = cube_of(points[i]);
      if (is_covered(colours.dag, level, cube))
        put_colour(svdag_colour(colours, level, cube[0], cube[1], cube[2]), &out[i]);
    }
  });
}

bool units_of(const DagView&, const std::array<int64_t, 3>& voxel, int64_t (&point)[3]) {
  for (size_t a = 0; a < 3; ++a) {
    if (std::abs(double(voxel[a])) >= kFarthestPoint) return false;
    point[a] = (2 * voxel[a] + 1) * (int64_t(1) << (kNearestBits - 1));
  }
  return true;
}
bool units_of(const DagView& dag, const std::array<double, 3>& world, int64_t (&point)[3]) {
  return snap_for_nearest(dag, {world[0], world[1], world[2]}, point);
}

template <class Point>
void find_nearest_of(const DagView& dag, std::span<const Point> points, double max_distance,
                     std::array<int32_t, 3>* voxels, double* distances, Executor* executor) {
  in_fast_pieces(points.size(), kNearestPerTask, executor, [&](size_t begin, size_t end) {
    for (size_t at = begin; at < end; at += kTogether) {
      const size_t count = std::min(kTogether, end - at);
      int64_t units[kTogether][3] = {};
      bool is_valid[kTogether];
      for (size_t i = 0; i < count; ++i) is_valid[i] = units_of(dag, points[at + i], units[i]);
      NearestPath paths[kTogether];
      find_paths(dag, units, count, paths);
      for (size_t i = 0; i < count; ++i) {
        NearestSetVoxel nearest;
        double& distance = distances[at + i];
        if (is_valid[i]) nearest = nearest_within(dag, units[i], paths[i], max_distance, &distance);
        const auto& [x, y, z] = nearest.voxel;
        voxels[at + i] = {int32_t(x), int32_t(y), int32_t(z)};
        if (nearest.found) continue;
        voxels[at + i] = {-1, -1, -1};
        distance = std::numeric_limits<double>::infinity();
      }
    }
  });
}

// Paints the covered cubes of a level in a box, in depth-first order, so that each chunk of colours
// is decoded once.
class ColourWindow {
 public:
  // `part`: what this object paints of `box`, which `out` holds.
  ColourWindow(const DagColours& colours, uint32_t level, const VoxelBox& box, const VoxelBox& part,
               Rgb* out)
      : view_(colours.view()),
        tables_(colours.tables()),
        reader_(view_, tables_.total()),
        level_(level),
        coloured_level_(level > view_.level() ? view_.level()
                                              : level - (view_.level() - level) % 2),
        min_(box.min),
        size_(box.max - box.min),
        part_(part),
        out_(out) {}

  void paint() { visit({}, LatticePoint(0), 0); }

 private:
  // The children of a cube that meet the part. Calls visit(child, corner, number).
  template <class Visit>
  void for_children(const CoveredCube& cube, const LatticePoint& corner, const Visit& visit) {
    const int64_t side = int64_t(1) << (level_ - cube.level - 1);
    for_covered_children(view_.dag, cube, [&](const CoveredCube& child) {
      const LatticePoint step(child.morton >> 2 & 1, child.morton >> 1 & 1, child.morton & 1);
      const LatticePoint at = corner + step * side;
      visit(child, at, part_.meets({at, at + side}));
    });
  }
  // `number`: of the first colour of the cube.
  void visit(const CoveredCube& cube, const LatticePoint& corner, uint64_t number) {
    if (cube.level == coloured_level_) {
      reader_.advance(number);
      fill(cube, corner, reader_.colour(number));
      return;
    }
    check_interrupt();
    number += view_.counts.own(cube.level);
    for_children(cube, corner, [&](const CoveredCube& child, const LatticePoint& at, bool meets) {
      if (meets) visit(child, at, number);
      number += tables_.of(child);
    });
  }
  void fill(const CoveredCube& cube, const LatticePoint& corner, uint32_t colour) {
    if (cube.level == level_) {
      const LatticePoint at = corner - min_;
      put_colour(colour, &out_[(at.x * size_.y + at.y) * size_.z + at.z]);
      return;
    }
    check_interrupt();
    for_children(cube, corner, [&](const CoveredCube& child, const LatticePoint& at, bool meets) {
      if (meets) fill(child, at, colour);
    });
  }

  const ColourView& view_;
  const ColourCountTables& tables_;
  ColourReader reader_;
  const uint32_t level_, coloured_level_;
  const LatticePoint min_, size_;
  const VoxelBox part_;
  Rgb* const out_;
};

// Calls visit(part) for slabs of `inside`, on all threads. They end at whole blocks of voxels.
template <class Visit>
void in_slabs(const VoxelBox& inside, Executor* executor, const Visit& visit) {
  const int64_t first = inside.min.x / 8 * 8, slabs = (inside.max.x - first + 7) / 8;
  const int64_t step = std::max<int64_t>(1, slabs / int64_t(4 * executor->workers()));
  executor->for_each(size_t((slabs + step - 1) / step), [&](size_t, size_t i) {
    VoxelBox part = inside;
    part.min.x = std::max(inside.min.x, first + 8 * step * int64_t(i));
    part.max.x = std::min(inside.max.x, first + 8 * step * int64_t(i + 1));
    visit(part);
  });
}

VoxelBox clipped(const VoxelBox& box, uint32_t level) {
  const int64_t side = int64_t(1) << level;
  return {glm::max(box.min, LatticePoint(0)), glm::min(box.max, LatticePoint(side))};
}

// The first brick in `box` that is number `first` or later: a depth-first walk.
class BrickList {
 public:
  BrickList(const DagView& dag, const VoxelBox& box, uint64_t first, size_t count)
      : dag_(dag), box_(box), first_(first), count_(count) {}
  std::vector<PlacedBrick> take() {
    if (!dag_.empty() && count_ > 0) visit(0, 0, LatticePoint(0), 0);
    return std::move(found_);
  }

 private:
  bool visit(uint32_t level, uint32_t node, const LatticePoint& corner, uint64_t number) {
    check_interrupt();
    const int64_t side = int64_t(1) << (dag_.levels - level);
    for (int a = 0; a < 3; ++a) {
      if (corner[a] >= box_.max[a] || corner[a] + side <= box_.min[a]) return true;
    }
    const uint64_t numbers = uint64_t(1) << 3 * (dag_.brick_level() - level);
    if (number + numbers <= first_) return true;
    if (level == dag_.brick_level()) {
      found_.push_back(
          {{int32_t(corner.x), int32_t(corner.y), int32_t(corner.z)}, dag_.bricks[node]});
      return found_.size() < count_;
    }
    for (unsigned c = 0; c < 8; ++c) {
      const uint32_t child = dag_child(dag_, level, node, c);
      if (child == kNoChild) continue;
      const LatticePoint step(c >> 2 & 1, c >> 1 & 1, c & 1);
      if (!visit(level + 1, child, corner + step * (side / 2), number + c * (numbers / 8)))
        return false;
    }
    return true;
  }

  const DagView& dag_;
  const VoxelBox box_;
  const uint64_t first_;
  const size_t count_;
  std::vector<PlacedBrick> found_;
};

bool any_in_box(const DagView& dag, const VoxelBox& box, uint32_t level, uint32_t node,
                const LatticePoint& corner) {
  check_interrupt();
  const LatticePoint end = corner + (int64_t(1) << (dag.levels - level));
  if (!box.meets({corner, end})) return false;
  if (box.holds({corner, end})) return true;
  if (level == dag.brick_level()) {
    const Brick brick = dag.bricks[node];
    for (unsigned bit = 0; bit < 64; ++bit) {
      if ((brick >> bit & 1) == 0) continue;
      const auto [x, y, z] = brick_voxel(bit);
      const LatticePoint voxel = corner + LatticePoint(x, y, z);
      if (box.holds({voxel, voxel + int64_t(1)})) return true;
    }
    return false;
  }
  const int64_t half = int64_t(1) << (dag.levels - level - 1);
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t child = dag_child(dag, level, node, c);
    const LatticePoint step(c >> 2 & 1, c >> 1 & 1, c & 1);
    if (child != kNoChild && any_in_box(dag, box, level + 1, child, corner + step * half))
      return true;
  }
  return false;
}

// Calls visit(voxel) for the set voxels of a level in `box`, in Morton order.
template <class Visit>
void for_voxels(const DagView& dag, uint32_t level, const VoxelBox& box, const Visit& visit) {
  const VoxelBox inside = clipped(box, level);
  if (inside.empty() || dag.empty()) return;
  CubeWalk(dag, level).visit(inside, [&](const VoxelCube& cube) {
    const int bits = std::countr_zero(uint64_t(cube.side));
    for (uint64_t code = 0; code < uint64_t(1) << 3 * bits; ++code) {
      if (code % 65536 == 0) check_interrupt();
      LatticePoint at(0);
      for (int b = 0; b < bits; ++b) {
        at.x |= int64_t(code >> (3 * b + 2) & 1) << b;
        at.y |= int64_t(code >> (3 * b + 1) & 1) << b;
        at.z |= int64_t(code >> 3 * b & 1) << b;
      }
      if (cube.side != kBlockSide || cube.block.get(unsigned(at.x), unsigned(at.y), unsigned(at.z)))
        visit(cube.origin + at);
    }
    return true;
  });
}

}  // namespace

void fill_window(const DagView& dag, uint32_t level, const VoxelBox& box, uint8_t* out,
                 Executor* executor) {
  const VoxelBox inside = clipped(box, level);
  if (inside.empty() || dag.empty()) return;
  const LatticePoint size = box.max - box.min;
  in_slabs(inside, executor, [&](const VoxelBox& part) {
    CubeWalk(dag, level).visit(part, [&](const VoxelCube& cube) {
      check_interrupt();
      const VoxelBox rows{glm::max(cube.origin, part.min),
                          glm::min(cube.origin + LatticePoint(cube.side), part.max)};
      for (int64_t x = rows.min.x; x < rows.max.x; ++x)
        for (int64_t y = rows.min.y; y < rows.max.y; ++y) {
          uint8_t* const row =
              out + ((x - box.min.x) * size.y + y - box.min.y) * size.z + rows.min.z - box.min.z;
          const size_t length = size_t(rows.max.z - rows.min.z);
          if (cube.side != kBlockSide) {
            std::fill_n(row, length, uint8_t(1));
            continue;
          }
          const unsigned bx = unsigned(x - cube.origin.x), by = unsigned(y - cube.origin.y);
          const unsigned bz = unsigned(rows.min.z - cube.origin.z);
          for (unsigned z = 0; z < length; ++z) row[z] = cube.block.get(bx, by, bz + z);
        }
      return true;
    });
  });
}

std::vector<std::array<int32_t, 3>> list_voxels(const DagView& dag, uint32_t level,
                                                const VoxelBox& box) {
  std::vector<std::array<int32_t, 3>> voxels;
  if (const VoxelBox inside = clipped(box, level); !inside.empty() && !dag.empty())
    voxels.reserve(CubeWalk(dag, level).count_voxels(inside));
  for_voxels(dag, level, box, [&](const LatticePoint& v) {
    voxels.push_back({int32_t(v.x), int32_t(v.y), int32_t(v.z)});
  });
  return voxels;
}

std::vector<std::array<int32_t, 3>> list_ball(const DagView& dag, const Vec3& center,
                                              double radius) {
  VoxelBox box;
  for (int a = 0; a < 3; ++a) {
    const double side = dag.resolution();
    box.min[a] = int64_t(std::clamp(std::floor(center[a] - radius) - 1, 0.0, side));
    box.max[a] = int64_t(std::clamp(std::floor(center[a] + radius) + 2, 0.0, side));
  }
  std::vector<std::array<int32_t, 3>> voxels;
  for_voxels(dag, dag.levels, box, [&](const LatticePoint& v) {
    double square = 0;
    for (int a = 0; a < 3; ++a) {
      const double off = std::max({double(v[a]) - center[a], center[a] - double(v[a] + 1), 0.0});
      square += off * off;
    }
    if (square <= radius * radius) voxels.push_back({int32_t(v.x), int32_t(v.y), int32_t(v.z)});
  });
  return voxels;
}

std::vector<PlacedBrick> next_bricks(const DagView& dag, const VoxelBox& box, uint64_t first,
                                     size_t count) {
  return BrickList(dag, box, first, count).take();
}

void look_up(const DagView& dag, std::span<const std::array<int64_t, 3>> points, uint8_t* set,
             Executor* executor) {
  look_up_all(dag, points, set, executor);
}

void look_up(const DagView& dag, std::span<const std::array<double, 3>> points, uint8_t* set,
             Executor* executor) {
  look_up_all(dag, points, set, executor);
}

void look_up_colours(const ColourView& colours, uint32_t level,
                     std::span<const std::array<int64_t, 3>> points, Rgb* out, Executor* executor) {
  look_up_colours_of(colours, level, points, out, executor,
                     [&](const auto& point) { return voxel_at(colours.dag, point); });
}

void look_up_colours(const ColourView& colours, uint32_t level,
                     std::span<const std::array<double, 3>> points, Rgb* out, Executor* executor) {
  look_up_colours_of(colours, level, points, out, executor, [&](const auto& point) {
    std::array<uint32_t, 3> voxel = voxel_at(colours.dag, point);
    for (uint32_t& v : voxel)
      if (v != ~0U) v >>= colours.dag.levels - level;
    return voxel;
  });
}

void fill_window_colours(const DagColours& colours, uint32_t level, const VoxelBox& box, Rgb* out,
                         Executor* executor) {
  const VoxelBox inside = clipped(box, level);
  if (inside.empty() || colours.view().dag.empty()) return;
  in_slabs(inside, executor,
           [&](const VoxelBox& part) { ColourWindow(colours, level, box, part, out).paint(); });
}

void find_nearest(const DagView& dag, std::span<const std::array<int64_t, 3>> points,
                  double max_distance, std::array<int32_t, 3>* voxels, double* distances,
                  Executor* executor) {
  find_nearest_of(dag, points, max_distance, voxels, distances, executor);
}

void find_nearest(const DagView& dag, std::span<const std::array<double, 3>> points,
                  double max_distance, std::array<int32_t, 3>* voxels, double* distances,
                  Executor* executor) {
  find_nearest_of(dag, points, max_distance, voxels, distances, executor);
}

bool any_in_box(const DagView& dag, const VoxelBox& box) {
  return !box.empty() && !dag.empty() && any_in_box(dag, box, 0, 0, LatticePoint(0));
}

void trace_rays(const DagView& dag, size_t count, double t_max,
                const std::function<void(size_t first, std::span<Ray> rays)>& make,
                const std::function<void(size_t first, std::span<const Hit> hits)>& take,
                Executor* executor) {
  const Tree64 tree = tree_if_it_pays(dag, count / executor->workers(), default_memory_limit());
  in_pieces(count, kRaysPerTask, executor, [&](size_t begin, size_t end) {
    Ray rays[kRaysTogether];
    Hit hits[kRaysTogether];
    for (size_t at = begin; at < end; at += kRaysTogether) {
      const size_t some = std::min(kRaysTogether, end - at);
      make(at, {rays, some});
      trace_closest(dag, tree.view(), rays, some, {0, t_max}, {}, hits);
      take(at, {hits, some});
    }
  });
}

}  // namespace svdag
