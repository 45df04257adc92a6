#include "verify/integrity/union_check.h"

#include <algorithm>
#include <span>

#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

class UnionCheck {
 public:
  UnionCheck(const DagView& dag, std::vector<uint32_t> layers)
      : dag_(dag), nodes_(std::move(layers)), answered_(kAnswers) {
    keep_distinct(0);
  }

  bool run(uint32_t first) { return holds(0, first, 0); }

 private:
  static constexpr size_t kAnswers = size_t(1) << 18;

  // Whether `node` has the voxels of the nodes from nodes_[begin] on.
  bool holds(uint32_t level, uint32_t node, size_t begin) {
    const size_t end = nodes_.size();
    if (end - begin == 1 && nodes_[begin] == node) return true;
    if (level == dag_.brick_level()) {
      uint64_t brick = 0;
      for (size_t i = begin; i < end; ++i) brick |= dag_.bricks[nodes_[i]];
      return brick == dag_.bricks[node];
    }
    check_interrupt();
    const Hash128 question = hash_of(level, node, begin);
    Hash128& answered = answered_[question[0] % kAnswers];
    if (answered == question) return true;
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
    answered = question;
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
  std::vector<Hash128> answered_;
};

}  // namespace

bool is_union_of(const DagView& dag, uint32_t first, std::vector<uint32_t> layers) {
  return UnionCheck(dag, std::move(layers)).run(first);
}

}  // namespace svdag
