#include "io/formats/dags/octree.h"

#include <array>

#include "io/formats/dags/child_order.h"
#include "io/formats/output.h"

namespace svdag {
namespace {

constexpr uint64_t kNoData = 0, kVoxelData = 1;

// Writes a node with the child mask `mask` (our child numbers). Its children are stored from `base`
// on in the format's order, or are all the node `base` if `same` is set.
void put_node(uint64_t data, uint64_t base, uint32_t mask, bool same, Output* out) {
  struct {
    uint64_t data, base;
    int8_t offset[8];
  } node{data, base, {}};
  static_assert(sizeof node == 24);
  int8_t next = 0;
  for (unsigned t = 0; t < 8; ++t) {
    const bool there = (mask >> mirrored_child(t) & 1) != 0;
    node.offset[t] = there ? next : int8_t(-1);
    if (there && !same) ++next;
  }
  out->put(std::as_bytes(std::span(&node, 1)));
}

// The number of the first child of each node.
class ChildNumbers {
 public:
  explicit ChildNumbers(const WholeDag& dag) : blocks_before_(dag.blocks_before()) {
    uint64_t next = 1;  // node 0 is the voxel
    begin_[dag.brick_level()] = next;
    next += blocks_before_[dag.bricks().size()];
    for (uint32_t k = dag.brick_level(); k-- > 0;) {
      begin_[k] = next;
      next += dag.words(k) - dag.nodes(k);
    }
    root_ = next;
  }
  uint64_t of_brick(uint32_t level, uint32_t brick) const {
    return begin_[level] + blocks_before_[brick];
  }
  // Each word before `word` either starts a node (`starts`) or is a child pointer.
  uint64_t of_node(uint32_t level, uint32_t word, const RankBitmap& starts) const {
    return begin_[level] + word - starts.rank(word);
  }
  uint64_t root() const { return root_; }

 private:
  BlockNumbers blocks_before_;
  std::array<uint64_t, kMaxSections> begin_{};  // [level]: first child of its nodes
  uint64_t root_;
};

// Writes the 2^3 blocks, the children of the bricks.
void put_blocks(const WholeDag& dag, Output* out) {
  for (const Brick brick : dag.bricks()) {
    for (unsigned t = 0; t < 8; ++t) {
      const uint32_t mask = uint32_t(brick >> (8 * mirrored_child(t)) & 0xff);
      if (mask != 0) put_node(kNoData, 0, mask, true, out);
    }
  }
}

// Writes the children of the nodes of `level`.
void put_children(const WholeDag& dag, uint32_t level, const ChildNumbers& numbers, Output* out) {
  const bool to_bricks = level + 1 == dag.brick_level();
  std::optional<RankBitmap> below;
  if (!to_bricks) below = dag.node_starts(level + 1);
  dag.for_each_node(level, [&](uint32_t mask, const uint32_t* children) {
    for (unsigned t = 0; t < 8; ++t) {
      const unsigned c = mirrored_child(t);
      if ((mask >> c & 1) == 0) continue;
      const uint32_t child = children[popcount8(mask & ((1U << c) - 1))];
      if (to_bricks) {
        put_node(kNoData, numbers.of_brick(level + 1, child), brick_octants(dag.bricks()[child]),
                 false, out);
      } else {
        put_node(kNoData, numbers.of_node(level + 1, child, *below), dag.mask(level + 1, child),
                 false, out);
      }
    }
  });
}

// Writes the data file: entry 0 is null, entry 1 the voxel (Morton code 0, white, no normal).
void write_data(const std::string& path) {
  Output out(path);
  for (const float white : {0.F, 1.F}) {
    out.put(uint64_t(0));
    for (int i = 0; i < 3; ++i) out.put(white);
    for (int i = 0; i < 3; ++i) out.put(0.F);
  }
  out.commit();
}

}  // namespace

std::vector<std::string> octree_files(const std::string& path) {
  return {path, path + "nodes", path + "data"};
}

void write_octree(const WholeDag& dag, const std::string& path) {
  for (const char* ending : {"", "data"})
    AtomicFile::check(path + ending);  // before any file is created
  const ChildNumbers numbers(dag);
  const std::vector<std::string> files = octree_files(path);
  Output nodes(files[1]);
  put_node(kVoxelData, 0, 0, false, &nodes);
  put_blocks(dag, &nodes);
  for (uint32_t k = dag.brick_level(); k-- > 0;) put_children(dag, k, numbers, &nodes);
  uint32_t root_mask = 0;
  dag.for_each_node(0, [&](uint32_t mask, const uint32_t*) { root_mask = mask; });
  put_node(kNoData, root_mask == 0 ? 0 : numbers.root() - uint64_t(popcount8(root_mask)), root_mask,
           false, &nodes);
  SVDAG_ASSERT(nodes.size() == 24 * (numbers.root() + 1));

  Output header(files[0]);
  header.put("#octreeheader 1\ngridlength " + std::to_string(uint64_t(1) << dag.levels()) +
             "\nn_nodes " + std::to_string(numbers.root() + 1) + "\nn_data 2\nEND\n");
  nodes.commit();
  write_data(files[2]);
  header.commit();
}

}  // namespace svdag
