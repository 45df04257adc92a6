// Vector kernel: the 64 voxels of a brick that a plane meets, over a range of offsets.
// Included once per instruction set (builder/overlap/kernels/kernels_vector.cpp).
#if defined(SVDAG_BUILDER_KERNEL_PLANE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SVDAG_BUILDER_KERNEL_PLANE_INL_H
#undef SVDAG_BUILDER_KERNEL_PLANE_INL_H
#else
#define SVDAG_BUILDER_KERNEL_PLANE_INL_H
#endif

#include "builder/overlap/kernels/kernel_common-inl.h"

HWY_BEFORE_NAMESPACE();
namespace svdag::HWY_NAMESPACE {
namespace {

PlaneVoxels plane(const PlaneBrick& p, int64_t low, int64_t high) noexcept {
  // With f the first offset of a voxel: it is set iff high - span <= f <= low, and clear for every
  // offset iff f > high or f < low - span; otherwise it straddles.
  const Longs d;
  using IntVec = hn::Vec<decltype(d)>;
  const IntVec set_from = hn::Set(d, high - p.span), set_to = hn::Set(d, low);
  const IntVec above = hn::Set(d, high), below = hn::Set(d, low - p.span);
  const IntVec far = hn::Set(d, kFarOffset), near = hn::Set(d, -kFarOffset);
  IntVec first_set = far, last_set = near, first_above = far, last_below = near;
  Brick voxels = 0, straddling = 0;
  for (unsigned o = 0; o < 8; ++o) {
    for (size_t i = 0; i < 8; i += kLongs) {
      const IntVec f = hn::Add(hn::Set(d, p.outer[o]), hn::LoadU(d, p.inner + i));
      const auto is_above = hn::Gt(f, above), is_below = hn::Lt(f, below);
      const auto is_set = hn::AndNot(hn::Or(hn::Lt(f, set_from), hn::Gt(f, set_to)),
                                     hn::MaskFromVec(hn::Set(d, int64_t(-1))));
      first_set = hn::Min(first_set, hn::IfThenElse(is_set, f, far));
      last_set = hn::Max(last_set, hn::IfThenElse(is_set, f, near));
      first_above = hn::Min(first_above, hn::IfThenElse(is_above, f, far));
      last_below = hn::Max(last_below, hn::IfThenElse(is_below, f, near));
      voxels |= Brick(bits(d, is_set)) << (8 * o + i);
      const auto decided = hn::Or(is_set, hn::Or(is_above, is_below));
      straddling |= Brick(bits(d, decided) ^ ((1U << kLongs) - 1)) << (8 * o + i);
    }
  }
  PlaneVoxels out{voxels, -kFarOffset, kFarOffset, straddling != 0};
  if (voxels != 0) {
    out.low = hn::GetLane(hn::MaxOfLanes(d, last_set));
    out.high = hn::GetLane(hn::MinOfLanes(d, first_set)) + p.span;
  }
  const int64_t next_above = hn::GetLane(hn::MinOfLanes(d, first_above));
  const int64_t next_below = hn::GetLane(hn::MaxOfLanes(d, last_below));
  if (next_above != kFarOffset && next_above - 1 < out.high) out.high = next_above - 1;
  if (next_below != -kFarOffset && next_below + p.span + 1 > out.low)
    out.low = next_below + p.span + 1;
  return out;
}

}  // namespace
}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
