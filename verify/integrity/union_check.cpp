#include "verify/integrity/union_check.h"

#include <algorithm>
#include <span>

#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

class UnionCheck {
 public:
  UnionCheck(const DagView& dag, std::vector<uint32_t> layers, uint64_t max_nodes)
      : dag_(dag), nodes_(std::move(layers)), known_(kKnown), left_(max_nodes) {
    keep_distinct(0);
  }

  std::optional<bool> run(uint32_t first) {
    const bool holds_all = holds(0, first, 0);
    return left_ > 0 ? std::optional(holds_all) : std::nullopt;
  }

 private:
  static constexpr size_t kKnown = size_t(1) << 18;

  // Whether `node` has the voxels of the nodes from nodes_[begin] on; false if none are left to
  // visit.
  bool holds(uint32_t level, uint32_t node, size_t begin) {
    const size_t end = nodes_.size();
    if (end - begin == 1 && nodes_[begin] == node) return true;
    left_ -= std::min<uint64_t>(left_, end - begin);
    if (left_ == 0) return false;
    if (level == dag_.brick_level()) {
      uint64_t brick = 0;
      for (size_t i = begin; i < end; ++i) brick |= dag_.bricks[nodes_[i]];
      return brick == dag_.bricks[node];
    }
    check_interrupt();
    const Hash128 key = hash_of(level, node, begin);
    if (known_[key[0] % kKnown] == key) return true;
    for (unsigned c = 0; c < 8; ++c) {
      const uint32_t child = dag_child(dag_, level, node, c);
      for (size_t i = begin; i < end; ++i) {
        const uint32_t other = dag_child(dag_, level, nodes_[i], c);
        if (other != kNoChild) nodes_.push_back(other);
      }
      keep_distinct(end);
      const bool some = nodes_.size() > end;
      const bool same = child == kNoChild ? !some : some && holds(level + 1, child, end);
      nodes_.resize(end);
      if (!same) return false;
    }
    known_[key[0] % kKnown] = key;
    return true;
  }

  void keep_distinct(size_t begin) {
    const auto from = nodes_.begin() + std::ptrdiff_t(begin);
    std::sort(from, nodes_.end());
    nodes_.erase(std::unique(from, nodes_.end()), nodes_.end());
  }

  Hash128 hash_of(uint32_t level, uint32_t node, size_t begin) const {
    const uint64_t seed = (uint64_t(level) << 32 | node) + 1;
    return hash128(std::as_bytes(std::span(nodes_).subspan(begin)), seed);
  }

  const DagView& dag_;
  std::vector<uint32_t> nodes_;  // of the layers, a list for each level of the descent
  std::vector<Hash128> known_;   // subproblems that hold
  uint64_t left_;                // nodes of layers to visit
};

}  // namespace

std::optional<bool> is_union_of(const DagView& dag, uint32_t first, std::vector<uint32_t> layers,
                                uint64_t max_nodes) {
  return UnionCheck(dag, std::move(layers), max_nodes).run(first);
}

}  // namespace svdag
