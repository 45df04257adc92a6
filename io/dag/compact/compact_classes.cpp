#include "io/dag/compact/compact_classes.h"

#include <algorithm>
#include <bit>

namespace svdag {
namespace {

constexpr uint32_t kMaxWidth = 32;

// Bits of a number below `count`.
uint32_t width_of(uint64_t count) {
  return count < 2 ? 0 : uint32_t(std::bit_width(count - 1));
}

// Calls visit(n) for the sizes that a class of at most `most` nodes may have: powers of two, and
// `most` itself as the last.
template <class Visit>
void for_sizes(uint64_t most, const Visit& visit) {
  for (uint32_t width = 0; width <= kMaxWidth; ++width) {
    const uint64_t size = std::min(uint64_t(1) << width, most);
    visit(size);
    if (size == most) return;
  }
}

}  // namespace

class ClassChoice {
 public:
  // `nodes`: of the level that refers to those counted.
  ClassChoice(const ReferenceCounts& counts, uint64_t nodes) : nodes_(nodes) {
    counts.for_each([&](uint32_t references, uint64_t with_these) {
      groups_.push_back({references, all_, references_});
      all_ += with_these;
      references_ += with_these * references;
      if (references == 1) private_ = with_these;
    });
  }

  void choose(NodeClasses* out) {
    for_sizes(all_ - private_,
              [&](uint64_t b) { try_sizes(CompactKind::kPrivate, private_, b, out); });
    for_sizes(all_, [&](uint64_t a) {
      for_sizes(all_ - a, [&](uint64_t b) { try_sizes(CompactKind::kExplicit, a, b, out); });
    });
  }

 private:
  // Nodes with equally many references.
  struct Group {
    uint32_t references;
    uint64_t nodes_before, references_before;  // of all groups before it
  };

  NodeClasses::Top top(uint64_t nodes) const {
    if (nodes == 0) return {};
    const auto after = std::partition_point(groups_.begin(), groups_.end(),
                                            [&](const Group& g) { return g.nodes_before < nodes; });
    const Group& last = after[-1];
    const uint64_t ties = nodes - last.nodes_before;
    return {last.references, ties, last.references_before + ties * last.references};
  }

  // `a` nodes in class A, `b` in B, the rest in C.
  void try_sizes(CompactKind kind, uint64_t a, uint64_t b, NodeClasses* out) {
    const bool is_private = kind == CompactKind::kPrivate;
    const NodeClasses::Top top_a = top(is_private ? 0 : a);
    NodeClasses::Top top_b = top(is_private ? b : a + b);
    CompactEntry entry{};
    entry.kind = uint32_t(kind);
    const uint64_t sizes[kClasses] = {a, b, all_ - a - b};
    for (uint32_t s = 0; s < kClasses; ++s) {
      entry.sizes[s] = uint32_t(sizes[s]);
      entry.widths[s] = has_stream(entry, s) ? width_of(sizes[s]) : 0;
    }
    entry.references[0] = is_private ? a : top_a.references;
    entry.references[1] = top_b.references - top_a.references;
    entry.references[2] = references_ - entry.references[0] - entry.references[1];
    const uint64_t bytes = compact_bytes(entry, nodes_);
    if (bytes >= least_bytes_) return;
    least_bytes_ = bytes;
    if (top_a.more_than == top_b.more_than) top_b.ties -= top_a.ties;
    out->entry_ = entry;
    out->a_ = top_a;
    out->b_ = top_b;
  }

  uint64_t nodes_;
  std::vector<Group> groups_;  // descending
  uint64_t all_ = 0, references_ = 0, private_ = 0;
  uint64_t least_bytes_ = UINT64_MAX;
};

NodeClasses::NodeClasses(const ReferenceCounts& counts, uint64_t nodes) {
  ClassChoice(counts, nodes).choose(this);
}

}  // namespace svdag
