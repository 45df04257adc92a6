// The vector kernels (builder/overlap/kernels/kernels.h), compiled once per instruction set by
// Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "builder/overlap/kernels/kernels_vector.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "builder/overlap/kernels/kernel_children-inl.h"
#include "builder/overlap/kernels/kernel_conservative-inl.h"
#include "builder/overlap/kernels/kernel_heights-inl.h"
#include "builder/overlap/kernels/kernel_plane-inl.h"
#include "builder/overlap/kernels/kernel_thin-inl.h"

HWY_BEFORE_NAMESPACE();
namespace svdag::HWY_NAMESPACE {

Kernels kernels_of_target() {
  return {hwy::TargetName(HWY_TARGET), int(kSixteen), children, {conservative, conservative_cube},
          {thin, thin_cube},           plane,         heights,  slabs};
}

}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace svdag {

HWY_EXPORT(kernels_of_target);

std::vector<Kernels> vector_kernels() {
  std::vector<Kernels> all;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    all.push_back(HWY_DYNAMIC_DISPATCH(kernels_of_target)());
  }
  hwy::SetSupportedTargetsForTest(0);
  return all;
}

}  // namespace svdag
#endif
