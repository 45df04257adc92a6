#include "verify/compare/distance_bounds.h"

#include <cmath>
#include <tuple>

#include "streaming/process/interrupt.h"
#include "verify/compare/centre_distance.h"
#include "verify/judge/judge_vdb.h"
#include "verify/sample/window_triangles.h"

namespace svdag {
namespace {

// A voxel that a distance does not clear: the bound is tested exactly against nearby triangles.
struct Suspect {
  LatticePoint voxel;
  bool set;      // in the file
  bool certain;  // wrong by OpenVDB's distance, by more than its float error
  bool near = false;

  bool operator<(const Suspect& other) const {
    return std::tie(voxel.x, voxel.y, voxel.z) <
           std::tie(other.voxel.x, other.voxel.y, other.voxel.z);
  }
};

// Checks the voxels of one window.
class WindowCheck {
 public:
  WindowCheck(CubeWalk* walk, const Grid& grid, Rule rule, const VoxelBox& box)
      : walk_(walk), grid_(grid), thin_(rule == Rule::kThin), box_(box) {
    const LatticePoint blocks = (box.max - box.min + (kBlockSide - 1)) / kBlockSide;
    blocks_ = blocks;
    has_distances_.resize(size_t(blocks.x * blocks.y * blocks.z));
    result_.windows = 1;
    const LatticePoint side = box.max - box.min;
    result_.tested = uint64_t(side.x) * uint64_t(side.y) * uint64_t(side.z);
  }

  BoundsComparison judge(std::span<const LatticeTriangle> triangles, size_t threads) {
    std::vector<LatticeTriangle> near;
    std::vector<Triangle> parts;
    double reach = 0;
    for (const LatticeTriangle& t : triangles) {
      if (!is_near(t, box_, grid_.fraction())) continue;
      near.push_back(t);
      append_near_part(t, box_, grid_.fraction(), &parts, &reach);
    }
    tolerance_ = 1e-6 + reach * 0x1p-48;
    if (!parts.empty())
      vdb_distances(parts, threads, [&](const LatticePoint& at, std::span<const float, 512> d) {
        check_block(at, d);
      });
    check_unseen_blocks();
    decide_suspects(near);
    return result_;
  }

 private:
  // The upper bound: its square in quarters, and its value.
  int upper_quarters() const { return thin_ ? 1 : 3; }
  double upper() const { return thin_ ? 0.5 : std::sqrt(0.75); }

  bool contains(const LatticePoint& v, const VoxelBox& box) const {
    for (int a = 0; a < 3; ++a)
      if (v[a] < box.min[a] || v[a] >= box.max[a]) return false;
    return true;
  }

  size_t window_number(const LatticePoint& origin) const {
    const LatticePoint b = (origin - box_.min) / kBlockSide;
    return size_t((b.x * blocks_.y + b.y) * blocks_.z + b.z);
  }

  // Compares one block of distances with the file's voxels; `at` is relative to the window.
  void check_block(const LatticePoint& at, std::span<const float, 512> distances) {
    const LatticePoint origin = at + box_.min;
    if (!contains(origin, box_)) return;
    has_distances_[window_number(origin)] = true;
    const Block file = walk_->block(origin);
    for (unsigned i = 0; i < 512; ++i) {
      const LatticePoint voxel = origin + LatticePoint(i >> 6, i >> 3 & 7, i & 7);
      if (contains(voxel, box_))
        check_voxel(voxel, file.words[i >> 6] >> (i & 63) & 1, distances[i]);
    }
  }

  void check_voxel(const LatticePoint& voxel, bool set, double d) {
    const bool selected = contains(voxel, grid_.selection);
    result_.file_voxels += set;
    result_.inner += selected && d <= 0.5;
    if (set && !selected) {  // wrong at any distance
      result_.add(voxel, false);
    } else if (set) {
      if (d >= upper() - tolerance_) suspects_.push_back({voxel, true, d > upper() + tolerance_});
    } else if (!thin_ && d <= 0.5 + tolerance_ && selected) {
      suspects_.push_back({voxel, false, d < 0.5 - tolerance_});
    }
  }

  // Checks the file's voxels in blocks without distances.
  void check_unseen_blocks() {
    walk_->visit(box_, [&](const VoxelCube& cube) {
      LatticePoint at;
      for (at.x = 0; at.x < cube.side; at.x += kBlockSide)
        for (at.y = 0; at.y < cube.side; at.y += kBlockSide)
          for (at.z = 0; at.z < cube.side; at.z += kBlockSide) {
            if (has_distances_[window_number(cube.origin + at)]) continue;
            const Block block = cube.side == kBlockSide ? cube.block : Block::full();
            for (unsigned i = 0; i < 512; ++i)
              if (block.words[i >> 6] >> (i & 63) & 1)
                check_voxel(cube.origin + at + LatticePoint(i >> 6, i >> 3 & 7, i & 7), true, kFar);
          }
      return true;
    });
  }

  // Decides the suspects: each triangle is tested with those in its box, enlarged by one voxel.
  void decide_suspects(const std::vector<LatticeTriangle>& triangles) {
    check_interrupt();
    std::sort(suspects_.begin(), suspects_.end());
    for (size_t i = 0; !suspects_.empty() && i < triangles.size(); ++i) test_suspects(triangles[i]);
    for (const Suspect& s : suspects_) {
      const bool wrong = s.set != s.near;
      if (!s.certain) ++result_.exact;
      if (wrong) {
        result_.add(s.voxel, !s.set);
      } else if (s.certain) {
        ++result_.vdb_errors;
      }
    }
  }

  void test_suspects(const LatticeTriangle& t) {
    const LatticeBox corners = box_of(t);
    const int64_t shift = grid_.fraction();
    const VoxelBox box{(corners.min >> shift) - int64_t(2), (corners.max >> shift) + int64_t(3)};
    constexpr int64_t kMin = INT64_MIN;
    auto s = std::lower_bound(suspects_.begin(), suspects_.end(),
                              Suspect{{box.min.x, kMin, kMin}, false, false});
    for (; s != suspects_.end() && s->voxel.x < box.max.x; ++s)
      if (!s->near && contains(s->voxel, box))
        s->near = centre_within(t, s->voxel, grid_.fraction(), s->set ? upper_quarters() : 1);
  }

  CubeWalk* walk_;
  const Grid& grid_;
  bool thin_;
  VoxelBox box_;
  LatticePoint blocks_{0};
  std::vector<bool> has_distances_;  // [block]: OpenVDB gave distances for it
  double tolerance_ = 0;             // of a distance, in voxels
  std::vector<Suspect> suspects_;
  BoundsComparison result_;
};

}  // namespace

void BoundsComparison::append(const BoundsComparison& later) {
  WrongVoxels::append(later);
  windows += later.windows;
  tested += later.tested;
  file_voxels += later.file_voxels;
  inner += later.inner;
  exact += later.exact;
  vdb_errors += later.vdb_errors;
}

BoundsWindows::BoundsWindows(const Grid& grid)
    : side_(std::min(kBoundsWindowSide, grid.resolution())), per_axis_(grid.resolution() / side_) {}

BoundsWindows::BoundsWindows(const Grid& grid, std::span<const LatticePoint> voxels)
    : BoundsWindows(grid) {
  drawn_.emplace();
  for (const LatticePoint& voxel : voxels) drawn_->push_back(window_number(voxel));
  std::sort(drawn_->begin(), drawn_->end());
  drawn_->erase(std::unique(drawn_->begin(), drawn_->end()), drawn_->end());
}

uint64_t BoundsWindows::window_number(const LatticePoint& voxel) const {
  const LatticePoint w = voxel / side_;
  return uint64_t((w.x * per_axis_ + w.y) * per_axis_ + w.z);
}

uint64_t BoundsWindows::size() const {
  return drawn_ ? drawn_->size() : uint64_t(per_axis_ * per_axis_ * per_axis_);
}

VoxelBox BoundsWindows::operator[](uint64_t i) const {
  const int64_t number = int64_t(drawn_ ? (*drawn_)[i] : i);
  const LatticePoint w(number / per_axis_ / per_axis_, number / per_axis_ % per_axis_,
                       number % per_axis_);
  return {w * side_, (w + int64_t(1)) * side_};
}

BoundsComparison judge_window(CubeWalk* walk, const Grid& grid, Rule rule, const VoxelBox& window,
                              std::span<const LatticeTriangle> triangles, size_t threads) {
  return WindowCheck(walk, grid, rule, window).judge(triangles, threads);
}

}  // namespace svdag
