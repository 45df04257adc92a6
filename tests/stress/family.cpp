#include "tests/stress/family.h"

namespace svdag {

std::vector<Family> all_families() {
  std::vector<Family> all;
  for (const auto& group :
       {shape_families(), plane_families(), contact_families(), coordinate_families(),
        format_families(), range_families(), patch_families()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace svdag
