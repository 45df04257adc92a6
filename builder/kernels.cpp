#include "builder/kernels.h"

namespace svdag {
namespace {

void plain_children(const Entry* entries, size_t count, const LatticePoint& corner, int64_t side,
                    ChildOverlap* out) noexcept {
  for (size_t i = 0; i < count; ++i) out[i] = overlap_children(entries[i], corner, side);
}

template <Brick (*overlap)(const Entry&, const LatticePoint&, int, DecisionCounts*) noexcept>
Brick plain_voxels(const Entry* entries, size_t count, const LatticePoint& corner, int fraction,
                   Brick wanted, DecisionCounts* counts) noexcept {
  Brick voxels = 0;
  for (size_t i = 0; i < count && voxels != wanted; ++i)
    voxels |= overlap(entries[i], corner, fraction, counts) & wanted;
  return voxels;
}

}  // namespace

const Kernels& plain_kernels() {
  static constexpr Kernels kPlain = {"plain", 1, plain_children, plain_voxels<overlap_brick>,
                                     plain_voxels<overlap_brick_thin>};
  return kPlain;
}

}  // namespace svdag
