// The traversal of the DAG: finds the closest solid cube along a ray, front to back.
//
// verify/trace/kernel/ray.h defines the result. Idea: the ray's cell is stored as one integer voxel
// coordinate per axis, whose bits are the path down from the root (Laine and Karras 2010).
//
//   descend  one bit per axis and level selects the child, without arithmetic on times
//   advance  the first of the three far planes is the exit; the new cell is origin + slope * t,
//            rounded down
//   ascend   the highest bit that differs between old and new cell gives the level of their common
//            ancestor, where the walk resumes at once, without popping. The same holds from ray to
//            ray: rays that start close together share most of their first path.
//
// The octant ahead: coordinates only increase along a mirrored ray, so only the children at or
// above its cell on all axes can still be met. If none of them is in the node's mask, the whole
// node is left at once. Bricks are tested in the same way, as 64-bit and as 8-bit masks.
//
// Exactness: comparing time(a, plane) decides the cell. The rounding error of origin + slope * t is
// at most 6 * 2^-53 * (|origin| + N), and so is the comparison's. Farther than margin =
// 2^-50 * (|origin| + N) from a plane, the rounded cell is therefore the right one; nearer, the
// plane's time is compared. The axis of the exit needs neither: its cell is at that plane. For
// origins more than 2^40 voxels away, neighbouring planes can have the same time, and the cell is
// found by bisection over the times of each axis. Rejected: times of middle planes during the
// descent (three per level).
//
// Depends only on ray.h, for host and CUDA. Pointers are trusted: DagFile::open validated them.
#pragma once

#include "verify/trace/kernel/ray.h"

namespace svdag {

// Masks of the octant ahead: the children, or voxels of a brick, at or above a cell on all axes.
class Ahead {
 public:
  SVDAG_HD explicit Ahead(unsigned flip) {
    const uint64_t low[3] = {0xf0f0f0f0f0f0f0f0U, 0xccccccccccccccccU, 0xaaaaaaaaaaaaaaaaU};
    const uint64_t high[3] = {0xffffffff00000000U, 0xffff0000ffff0000U, 0xff00ff00ff00ff00U};
    children_ = ~uint64_t(0);
    for (int a = 0; a < 3; ++a) {
      const uint64_t turn = flip >> (2 - a) & 1U ? ~uint64_t(0) : 0;
      low_[a] = low[a] ^ turn;
      high_[a] = high[a] ^ turn;
      children_ &= low_[a] | ~high_[a];
    }
  }
  // The children ahead of child c, itself included (c and the mask in file coordinates).
  SVDAG_HD unsigned children(unsigned c) const { return unsigned(children_ >> (8 * c)) & 0xffU; }
  // The voxels of a brick ahead of the one at (x, y, z) & 3, itself included. `at` is mirrored; the
  // mask is in file coordinates.
  SVDAG_HD uint64_t voxels(const uint32_t at[3]) const {
    return from(0, at[0]) & from(1, at[1]) & from(2, at[2]);
  }

 private:
  SVDAG_HD uint64_t from(int a, uint32_t k) const {
    const uint64_t even = k & 2U ? high_[a] : ~uint64_t(0);
    const uint64_t odd = k & 2U ? high_[a] & low_[a] : high_[a] | low_[a];
    return k & 1U ? odd : even;
  }
  uint64_t low_[3], high_[3];  // voxels of a brick whose mirrored coordinate is odd; is 2 or 3
  uint64_t children_;          // byte c: the children ahead of child c
};

// Traces rays through one DAG, one after the other. Consecutive rays share the path of nodes.
class Tracer {
 public:
  SVDAG_HD explicit Tracer(const DagView& dag) : dag_(dag) { path_[0] = 0; }
  explicit Tracer(DagView&&) = delete;  // the view must outlive this

  // The first solid cube that the ray meets within `span`.
  SVDAG_HD Hit closest(const Ray& ray, const Span& span = {}, const Cut& cut = {});

 private:
  template <bool kCut>
  class RayWalk;

  const DagView& dag_;
  uint32_t cell_[3] = {};     // last cell of the previous ray, in file coordinates
  uint32_t valid_level_ = 0;  // path_[0 .. valid_level_] are the path to cell_
  uint32_t path_[kMaxSections];
};

// The walk of one ray. Coordinates are mirrored; Tracer's are not.
template <bool kCut>
class Tracer::RayWalk {
 public:
  SVDAG_HD RayWalk(Tracer* tracer, const Ray& ray, const Cut& cut)
      : tracer_(*tracer),
        dag_(tracer->dag_),
        ray_(ray, dag_.resolution()),
        cut_(cut, ray, dag_.levels),
        ahead_(ray_.flip) {
    double farthest = 0;
    for (int a = 0; a < 3; ++a) {
      const double far = ray_.origin[a] < 0 ? -ray_.origin[a] : ray_.origin[a];
      farthest = far > farthest ? far : farthest;
    }
    margin_ = farthest < 0x1p40 ? (farthest + dag_.resolution()) * 0x1p-50 : 1;
  }

  SVDAG_HD Hit closest(Span span) {
    Hit hit;
    if (dag_.empty() || !ray_.clip(dag_.resolution(), &span)) return hit;
    t_ = span.begin;
    end_ = span.end;
    const uint32_t nowhere[3] = {};
    const double never[3] = {1e308, 1e308, 1e308};
    locate(nowhere, never);
    uint32_t level = resume();
    if (kCut && cut_.solid(0, dag_.resolution(), t_)) return ray_.hit(dag_.levels, 0, nowhere, t_);
    do {
      const uint32_t found = descend(&level);
      if (found != kNone) {
        uint32_t corner[3];
        for (int a = 0; a < 3; ++a) corner[a] = cell_[a] & ~0U << (dag_.levels - found);
        hit = ray_.hit(dag_.levels, found, corner, t_);
        break;
      }
    } while (advance(&level));
    save_path(level);
    hit.steps = steps_;
    return hit;
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffU;

  // Descends from path_[level] along the cell's bits. Returns the level of the solid cube that it
  // reaches, or kNone with side_ = side of the cube to leave, with nothing ahead in it.
  SVDAG_HD uint32_t descend(uint32_t* level) {
    const uint32_t bricks = dag_.brick_level();
    uint32_t node = tracer_.path_[*level];
    for (uint32_t k = *level; k < bricks; ++k) {
      const uint32_t shift = dag_.levels - 1 - k;
      const unsigned c = child_at(shift) ^ ray_.flip;
      const uint32_t mask = dag_mask(dag_, k, node);
      const uint32_t others = mask & ahead_.children(c) & ~(1U << c);
      const uint32_t leave = others != 0 ? 1U << shift : alone_[k];
      if (!(mask >> c & 1U)) {
        *level = k;
        side_ = leave;
        return kNone;
      }
      alone_[k + 1] = leave;
      node = dag_present_child(dag_, k, node, c);
      tracer_.path_[k + 1] = node;
      if (kCut && cut_.solid(k + 1, double(1U << shift), t_)) {
        *level = k + 1;
        return k + 1;
      }
    }
    *level = bricks;
    return in_brick(dag_.bricks[node]);
  }

  // The same in a brick, whose bytes are blocks of 2^3 voxels.
  SVDAG_HD uint32_t in_brick(uint64_t brick) {
    const unsigned block = child_at(1) ^ ray_.flip, voxel = child_at(0) ^ ray_.flip;
    const unsigned byte = unsigned(brick >> (8 * block)) & 0xffU;
    // A block is tested against the cut where it is entered, not again at each of its voxels.
    if (kCut && byte != 0 && changed_bit_ > 0 && cut_.solid(dag_.levels - 1, 2, t_))
      return dag_.levels - 1;
    if (byte >> voxel & 1U) return dag_.levels;
    if ((byte & ahead_.children(voxel)) != 0) {
      side_ = 1;
    } else if (kCut || (brick & ahead_.voxels(cell_)) != 0) {
      side_ = 2;  // with a cut, a later block may be solid although none of its voxels is ahead
    } else {
      side_ = alone_[dag_.brick_level()];
    }
    return kNone;
  }

  SVDAG_HD unsigned child_at(uint32_t shift) const {
    return octant_of(cell_[0], cell_[1], cell_[2], shift);
  }

  // Leaves the cube of side side_ that contains the cell. False at the end of the ray.
  SVDAG_HD bool advance(uint32_t* level) {
    uint32_t far[3];
    double times[3];
    for (int a = 0; a < 3; ++a) {
      far[a] = (cell_[a] | (side_ - 1)) + 1;
      times[a] = ray_.time(a, far[a]);
    }
    const double yz = times[1] < times[2] ? times[1] : times[2];
    t_ = times[0] < yz ? times[0] : yz;
    if (!(t_ < end_)) return false;
    ++steps_;
    const uint32_t x = cell_[0], y = cell_[1], z = cell_[2];
    locate(far, times);
    changed_bit_ = highest_bit((x ^ cell_[0]) | (y ^ cell_[1]) | (z ^ cell_[2]));
    const uint32_t common = dag_.levels - 1 - changed_bit_;
    *level = common < dag_.brick_level() ? common : dag_.brick_level();
    return true;
  }

  // Sets cell_ to the cell at time t_, given that the planes far[a] are crossed at times[a] >= t_.
  SVDAG_HD void locate(const uint32_t far[3], const double times[3]) {
    if (margin_ >= 0.5) return bisect();
    bool unsure = false;
    for (int a = 0; a < 3; ++a) {
      const double position = ray_.origin[a] + ray_.slope[a] * t_;
      const uint32_t below = uint32_t(int32_t(position));
      const double off = position - double(int32_t(below)) - 0.5;
      const bool crossed = times[a] <= t_;
      unsure |= !crossed & ((off < 0 ? -off : off) > 0.5 - margin_);
      cell_[a] = crossed ? far[a] : below;
    }
    if (unsure) locate_exactly(far, times);
  }

  SVDAG_HD void locate_exactly(const uint32_t far[3], const double times[3]) {
    for (int a = 0; a < 3; ++a) {
      const uint32_t nearest = uint32_t(ray_.origin[a] + ray_.slope[a] * t_ + 0.5);
      cell_[a] = times[a] <= t_ ? far[a] : nearest - uint32_t(!(ray_.time(a, nearest) <= t_));
    }
  }

  SVDAG_HD void bisect() {
    for (int a = 0; a < 3; ++a) {
      uint32_t passed = 0;  // the last plane with time <= t_
      for (uint32_t step = dag_.resolution() / 2; step > 0; step /= 2) {
        if (ray_.time(a, passed + step) <= t_) passed += step;
      }
      cell_[a] = passed;
    }
  }

  // The level of the deepest node that the previous ray's path shares with the first cell's.
  SVDAG_HD uint32_t resume() {
    alone_[0] = dag_.resolution();
    if (kCut) return 0;  // cubes of the shared path may be solid
    uint32_t differ = 0;
    for (int a = 0; a < 3; ++a) differ |= file_coordinate(a) ^ tracer_.cell_[a];
    const uint32_t common = differ == 0 ? kNone : dag_.levels - 1 - highest_bit(differ);
    const uint32_t level = common < tracer_.valid_level_ ? common : tracer_.valid_level_;
    for (uint32_t k = 0; k < level; ++k) alone_[k + 1] = dag_.resolution() >> (k + 1);
    return level;
  }

  SVDAG_HD void save_path(uint32_t level) {
    for (int a = 0; a < 3; ++a) tracer_.cell_[a] = file_coordinate(a);
    tracer_.valid_level_ = level;
  }

  SVDAG_HD uint32_t file_coordinate(int a) const {
    return ray_.flip >> (2 - a) & 1U ? dag_.resolution() - 1 - cell_[a] : cell_[a];
  }

  Tracer& tracer_;
  const DagView& dag_;
  const MirroredRay ray_;
  const CutOfRay cut_;
  const Ahead ahead_;
  double margin_, t_ = 0, end_ = 0;
  uint32_t cell_[3], side_ = 0, steps_ = 0;
  uint32_t changed_bit_ = 31;  // the highest bit of cell_ that the last step changed
  // alone_[k]: side of the largest cube that contains path_[k] and nothing else ahead.
  uint32_t alone_[kMaxSections];
};

SVDAG_HD inline Hit Tracer::closest(const Ray& ray, const Span& span, const Cut& cut) {
  return cut.cuts(dag_.levels) ? RayWalk<true>(this, ray, cut).closest(span)
                               : RayWalk<false>(this, ray, cut).closest(span);
}

SVDAG_HD inline Hit trace_closest(const DagView& dag, const Ray& ray, const Span& span = {},
                                  const Cut& cut = {}) {
  return Tracer(dag).closest(ray, span, cut);
}

// True if the ray meets a solid cube within `span`.
SVDAG_HD inline bool trace_any(const DagView& dag, const Ray& ray, const Span& span = {},
                               const Cut& cut = {}) {
  return Tracer(dag).closest(ray, span, cut).found;
}

}  // namespace svdag
