#include "builder/descend/rules.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>

namespace svdag {
namespace {

// n . x on the closed voxel.
OffsetRange offsets_of_closed_voxel(const int64_t n[3], int fraction) {
  int64_t negative = 0, positive = 0;
  for (int a = 0; a < 3; ++a) (n[a] < 0 ? negative : positive) += n[a];
  return {negative << fraction, positive << fraction};
}

// (m - d, m + d], m at the voxel's centre, 2d = |n_w| * side for the dominant axis w.
OffsetRange offsets_of_centre_segment(const int64_t n[3], int fraction) {
  const int64_t dominant = std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])});
  const int64_t centre = (n[0] + n[1] + n[2]) << (fraction - 1);
  const int64_t half = dominant << (fraction - 1);
  return {centre - half + 1, centre + half};
}

constexpr SurfaceRule kSurfaceRules[] = {
    {Rule::kConservative, &Kernels::conservative, offsets_of_closed_voxel, false,
     "50597f380fa601c724e6f99b8d00c7f5"},
    {Rule::kThin, &Kernels::thin, offsets_of_centre_segment, true,
     "46fe9462a409d09ba88bfb5c1a55ae18"},
};
constexpr const SurfaceRule& kConservativeSurface = kSurfaceRules[0];
// [Rule]: of the rule's surface; no bake has rule points.
constexpr const SurfaceRule* kSurfaceOf[] = {&kConservativeSurface, &kSurfaceRules[1],
                                             &kConservativeSurface, &kConservativeSurface,
                                             &kConservativeSurface};
static_assert(std::size(kSurfaceOf) == std::size(kRuleNames));

}  // namespace

const SurfaceRule& surface_rule(Rule rule) {
  return *kSurfaceOf[size_t(rule)];
}

}  // namespace svdag
