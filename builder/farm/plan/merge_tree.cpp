#include "builder/farm/plan/merge_tree.h"

#include <numeric>

#include "streaming/error.h"

namespace svdag {

MergeTree merge_tree(size_t leaves, size_t fan_in) {
  SVDAG_ASSERT(leaves > 0 && fan_in >= 2);
  MergeTree tree;
  std::vector<size_t> level(leaves);
  std::iota(level.begin(), level.end(), size_t(0));
  do {
    const size_t groups = (level.size() + fan_in - 1) / fan_in;
    std::vector<size_t> above;
    for (size_t g = 0; g < groups; ++g) {
      const auto begin = level.begin() + ptrdiff_t(level.size() * g / groups);
      const auto end = level.begin() + ptrdiff_t(level.size() * (g + 1) / groups);
      above.push_back(leaves + tree.size());
      tree.emplace_back(begin, end);
    }
    level = std::move(above);
  } while (level.size() > 1);
  return tree;
}

}  // namespace svdag
