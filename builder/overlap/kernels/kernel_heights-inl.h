// Vector kernels: the heights of a plane over the columns of a cube of 8x8x8 voxels, and of a
// brick. Included once per instruction set (builder/overlap/kernels/kernels_vector.cpp).
#if defined(SVDAG_BUILDER_KERNEL_HEIGHTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SVDAG_BUILDER_KERNEL_HEIGHTS_INL_H
#undef SVDAG_BUILDER_KERNEL_HEIGHTS_INL_H
#else
#define SVDAG_BUILDER_KERNEL_HEIGHTS_INL_H
#endif

#include "builder/overlap/kernels/kernel_common-inl.h"

HWY_BEFORE_NAMESPACE();
namespace svdag::HWY_NAMESPACE {
namespace {

using Ints = hn::CappedTag<int32_t, 8>;
constexpr size_t kInts = hn::MaxLanes(Ints());

alignas(32) constexpr int32_t kRowJ[8] = {0, 1, 2, 3, 4, 5, 6, 7};
alignas(32) constexpr int32_t kLastRowJ[8] = {8, 1, 2, 3, 4, 5, 6, 7};     // h(8, j)
alignas(32) constexpr int32_t kLastColumnI[8] = {1, 1, 2, 3, 4, 5, 6, 7};  // h(i, 8)

ColumnParities heights(int32_t first, int32_t step_u, int32_t step_v) noexcept {
  const Ints d;
  using IntVec = hn::Vec<Ints>;
  const IntVec lowest = hn::Set(d, kMinHeight), highest = hn::Set(d, kMaxHeight);
  const IntVec fraction_mask = hn::Set(d, kHeightFraction), zero = hn::Zero(d);
  IntVec min = fraction_mask, max = zero;
  const auto parities = [&](IntVec h) HWY_ATTR {
    h = hn::Min(hn::Max(h, lowest), highest);
    const IntVec fraction = hn::And(h, fraction_mask);
    min = hn::Min(min, fraction);
    max = hn::Max(max, fraction);
    return bits(d, hn::Lt(hn::ShiftLeft<31 - kHeightBits>(h), zero));
  };
  const IntVec corner = hn::Set(d, first), u = hn::Set(d, step_u), v = hn::Set(d, step_v);
  const IntVec last_row = hn::Set(d, first - 8 * step_u);
  const IntVec last_column = hn::Set(d, first - 8 * step_v);
  ColumnParities out{0, 0, 0, 0};
  for (size_t lane = 0; lane < 8; lane += kInts) {
    IntVec h = hn::Sub(corner, hn::Mul(hn::Load(d, kRowJ + lane), v));
    for (unsigned i = 0; i < 8; ++i) {
      out.rows |= uint64_t(parities(h)) << (8 * i + lane);
      h = hn::Sub(h, u);
    }
    out.last |= parities(hn::Sub(last_row, hn::Mul(hn::Load(d, kLastRowJ + lane), v))) << lane |
                parities(hn::Sub(last_column, hn::Mul(hn::Load(d, kLastColumnI + lane), u)))
                    << (8 + lane);
  }
  out.min_fraction = hn::GetLane(hn::MinOfLanes(d, min));
  out.max_fraction = hn::GetLane(hn::MaxOfLanes(d, max));
  return out;
}

// Row i and column j of the 16 columns 4i + j of a brick.
alignas(32) constexpr int32_t kBrickI[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
alignas(32) constexpr int32_t kBrickJ[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};

BrickSlabs slabs(int32_t first, int32_t step_u, int32_t step_v, int32_t drop) noexcept {
  constexpr int32_t kVoxel = 1 << kHeightBits;
  const Ints d;
  const auto corner = hn::Set(d, first), u = hn::Set(d, step_u), v = hn::Set(d, step_v);
  BrickSlabs out = 0;
  for (size_t lane = 0; lane < 16; lane += kInts) {
    const auto row = hn::Sub(corner, hn::Mul(hn::Load(d, kBrickI + lane), u));
    const auto top = hn::Sub(row, hn::Mul(hn::Load(d, kBrickJ + lane), v));
    const auto bottom = hn::Sub(top, hn::Set(d, drop));
    for (int k = 0; k < 4; ++k) {
      const auto set = hn::And(hn::Gt(top, hn::Set(d, k * kVoxel - 1)),
                               hn::Gt(hn::Set(d, (k + 1) * kVoxel), bottom));
      out |= BrickSlabs(bits(d, set)) << (16 * unsigned(k) + lane);
    }
  }
  return out;
}

}  // namespace
}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
