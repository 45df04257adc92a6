// Which nodes of a level are in which class of the compact layout (io/dag/compact_view.h): the
// choice that takes the fewest bytes.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "io/dag/compact_view.h"

namespace svdag {

// The numbers of references to the nodes of a level.
class ReferenceCounts {
 public:
  void add(uint32_t references) {
    references < small_.size() ? ++small_[references] : ++large_[references];
  }
  // Calls visit(references, number of nodes with this number), descending.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (auto at = large_.rbegin(); at != large_.rend(); ++at) visit(at->first, at->second);
    for (size_t references = small_.size(); references-- > 0;) {
      if (small_[references] != 0) visit(uint32_t(references), small_[references]);
    }
  }

 private:
  std::vector<uint64_t> small_ = std::vector<uint64_t>(1024);  // [references]: number of nodes
  std::map<uint32_t, uint64_t> large_;
};

// Assigns nodes to classes; they must be passed in content order.
class NodeClasses {
 public:
  // `nodes`: of the level that refers to those counted. Fewest bytes; of equals private first, then
  // the smallest widths.
  NodeClasses(const ReferenceCounts& counts, uint64_t nodes);

  const CompactEntry& entry() const { return entry_; }
  bool has_private() const { return entry_.kind == uint32_t(CompactKind::kPrivate); }
  // The class, 0 .. 2, of the next node.
  uint32_t class_of(uint32_t references) {
    if (has_private() && references == 1) return 0;
    if (!has_private() && take(&a_, references)) return 0;
    return take(&b_, references) ? 1 : 2;
  }

 private:
  friend class ClassChoice;
  // The most referenced nodes: all with more than `more_than` references, and the first `ties`, in
  // content order, with exactly `more_than`.
  struct Top {
    uint32_t more_than = UINT32_MAX;
    uint64_t ties = 0;
    uint64_t references = 0;  // to all of them
  };
  static bool take(Top* top, uint32_t references) {
    if (references > top->more_than) return true;
    if (references < top->more_than || top->ties == 0) return false;
    --top->ties;
    return true;
  }

  CompactEntry entry_{};
  Top a_, b_;  // b_ includes a_, except the ties
};

}  // namespace svdag
