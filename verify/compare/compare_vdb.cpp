#include "verify/compare/compare_vdb.h"

#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// Calls `f` with the set voxels of a cube until it returns false.
bool each_voxel(const VoxelCube& cube, const std::function<bool(const LatticePoint&)>& f) {
  for (int64_t x = 0; x < cube.side; ++x)
    for (int64_t y = 0; y < cube.side; ++y)
      for (int64_t z = 0; z < cube.side; ++z) {
        if (cube.side == kBlockSide && !cube.block.get(unsigned(x), unsigned(y), unsigned(z)))
          continue;
        if (!f(cube.origin + LatticePoint(x, y, z))) return false;
      }
  return true;
}

bool contains(const VoxelBox& box, const VoxelBox& part) {
  for (int a = 0; a < 3; ++a)
    if (part.min[a] < box.min[a] || part.max[a] > box.max[a]) return false;
  return true;
}

bool meet(const VoxelBox& a, const VoxelBox& b) {
  for (int i = 0; i < 3; ++i)
    if (a.min[i] >= b.max[i] || b.min[i] >= a.max[i]) return false;
  return true;
}

}  // namespace

VdbComparer::VdbComparer(const VdbGrid& theirs, CubeWalk* ours, const IndexMap& map,
                         const VoxelBox* window)
    : theirs_(theirs), ours_(ours), map_(map), window_(window) {
  if (window_ != nullptr && !window_->empty()) their_window_ = map_.back(*window_);
}

Block VdbComparer::our_block(const LatticePoint& origin) const {
  const LatticePoint corner = map_(VoxelBox{origin, origin + kBlockSide}).min;
  const Block block = ours_->block(corner);
  if (!map_.changes_axes()) return block;
  Block permuted;
  for (unsigned bit = 0; bit < 512; ++bit) {
    const unsigned x = bit >> 6, y = bit >> 3 & 7, z = bit & 7;
    const LatticePoint at = map_(origin + LatticePoint(x, y, z)) - corner;
    if (block.get(unsigned(at.x), unsigned(at.y), unsigned(at.z))) permuted.set(x, y, z);
  }
  return permuted;
}

void VdbComparer::compare_block(VoxelCube cube, const Found& found) {
  if (window_ != nullptr) cube.block.cut(cube.origin, their_window_);
  const Block ours = our_block(cube.origin);
  const uint64_t both = (cube.block & ours).count();
  cube.block = cube.block.without(ours);
  found(both, cube);
}

void VdbComparer::split(const VoxelCube& cube, const Found& found) {
  if (window_ != nullptr && !meet(cube.box(), their_window_)) return;
  if (cube.side == kBlockSide) return compare_block(cube, found);
  if (window_ == nullptr || contains(their_window_, cube.box())) {
    const uint64_t set = ours_->count_voxels(map_(cube.box()));
    if (set == 0) return found(0, cube);
    if (set == cube.count()) return found(set, {cube.origin, kBlockSide, {}});
  }
  const int64_t side = cube.side > 128 ? 128 : kBlockSide;
  LatticePoint at;
  for (at.x = 0; at.x < cube.side; at.x += side)
    for (at.y = 0; at.y < cube.side; at.y += side)
      for (at.z = 0; at.z < cube.side; at.z += side)
        split({cube.origin + at, side, side == kBlockSide ? Block::full() : Block()}, found);
}

void VdbComparer::visit_extra(const std::function<bool(const LatticePoint&)>& sink) {
  uint64_t cubes = 0;
  ours_->visit(window(), [&](const VoxelCube& cube) {
    if (++cubes % 1024 == 0) check_interrupt();
    return each_voxel(cube, [&](const LatticePoint& voxel) {
      return theirs_.get(map_.back(voxel)) || sink(voxel);
    });
  });
}

VoxelBox VdbComparer::window() const {
  constexpr int64_t kAll = int64_t(1) << 40;
  return window_ != nullptr ? *window_ : VoxelBox{LatticePoint(0), LatticePoint(kAll)};
}

VdbComparison VdbComparer::compare(uint64_t max_listed) {
  VdbComparison result;
  uint64_t cubes = 0;
  theirs_.visit([&](const VoxelCube& cube) {
    if (++cubes % 1024 == 0) check_interrupt();
    split(cube, [&](uint64_t both, const VoxelCube& missing) {
      result.both += both;
      result.missing += missing.count();
      each_voxel(missing, [&](const LatticePoint& voxel) {
        if (result.first_missing.size() >= max_listed) return false;
        result.first_missing.push_back(map_(voxel));
        return true;
      });
    });
    return true;
  });
  result.extra = ours_->count_voxels(window()) - result.both;
  const uint64_t to_find = std::min(max_listed, result.extra);
  if (to_find > 0)
    visit_extra([&](const LatticePoint& voxel) {
      result.first_extra.push_back(voxel);
      return result.first_extra.size() < to_find;
    });
  return result;
}

void VdbComparer::write_difference(VdbWriter* writer) {
  writer->begin("missing", theirs_.centres());
  theirs_.visit([&](const VoxelCube& cube) {
    split(cube, [&](uint64_t, const VoxelCube& missing) {
      if (missing.count() > 0) writer->add(missing);
    });
    return true;
  });
  writer->begin("extra", theirs_.centres());
  visit_extra([&](const LatticePoint& voxel) {
    writer->add_voxel(map_.back(voxel));
    return true;
  });
}

}  // namespace svdag
