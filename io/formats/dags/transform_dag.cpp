#include "io/formats/dags/transform_dag.h"

#include <array>
#include <vector>

#include "io/formats/dags/child_order.h"
#include "io/formats/graph_window.h"
#include "io/formats/output.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint32_t kTransformDagVersion = 2, kTypeDag = 1;

class TransformDagGraph : public NodeGraph {
 public:
  explicit TransformDagGraph(const File& file) : nodes_(file), bricks_(file) {
    ByteStream stream(file);
    if (header_value<uint32_t>(&stream) != kTransformDagMagic)
      fail_input(file.path(), "is not a transform-DAG .svo (wrong magic number)", 0);
    if (header_value<uint32_t>(&stream) != kTransformDagVersion)
      fail_input(file.path(), "has an unsupported .svo version (2 is supported)", 4);
    const uint64_t sections = header_value<uint64_t>(&stream);
    const int levels = checked_levels(file, sections - 1, 8);
    for (int i = 0; i <= levels; ++i) sections_.push_back(section(&stream, 32));
    leaves_ = section(&stream, 8);
    if (sections_.back().count == 0) fail_input(file.path(), "has no root", 8);
    if (header_value<uint32_t>(&stream) != 1U << levels)
      fail_input(file.path(), "its resolution does not match its levels", stream.offset() - 4);
    if (header_value<uint32_t>(&stream) != uint32_t(levels))
      fail_input(file.path(), "its root is not on its last level", stream.offset() - 4);
    if (header_value<uint32_t>(&stream) > kTypeDag)
      fail_input(file.path(),
                 "has transforms: only trees and DAGs without transforms are supported",
                 stream.offset() - 4);
    grid_.levels = levels;
    grid_.selection = grid_.whole();
  }

  Grid grid() const override { return grid_; }

  std::array<uint32_t, 8> children(int level, uint32_t id) override {
    const size_t section = size_t(grid_.levels - level);
    const uint64_t below = section == 3 ? leaves_.count : sections_[section - 1].count;
    const uint64_t at = sections_[section].offset + 32 * uint64_t(id);
    std::array<uint32_t, 8> result;
    for (unsigned t = 0; t < 8; ++t) {
      const uint32_t child = nodes_.u32(at + 4 * t);
      if (child != kNoChild && child >= below)
        fail_input(nodes_.path(), "damaged file: a child index is out of range", at + 4 * t);
      result[mirrored_child(t)] = child;
    }
    return result;
  }
  Brick brick(uint32_t id) override {
    return mirrored_brick(bricks_.u64(leaves_.offset + 8 * uint64_t(id)));
  }

 private:
  struct Section {
    uint64_t offset, count;
  };

  static Section section(ByteStream* stream, uint64_t bytes_each) {
    const uint64_t count = header_value<uint64_t>(stream);
    const Section result{stream->offset(), count};
    if (count > stream->remaining() / bytes_each)
      fail_input(stream->file().path(), "damaged file: a level is larger than the file",
                 result.offset - 8);
    stream->skip(count * bytes_each);
    return result;
  }

  GraphWindow nodes_, bricks_;
  std::vector<Section> sections_;  // indexed by log2 of the side of their nodes
  Section leaves_{};
  Grid grid_;
};

}  // namespace

void write_transform_dag(const WholeDag& dag, const std::string& path) {
  Output out(path);
  out.put(kTransformDagMagic);
  out.put(kTransformDagVersion);
  out.put(uint64_t(dag.levels() + 1));
  for (int empty = 0; empty < 3; ++empty) out.put(uint64_t(0));
  for (uint32_t k = dag.brick_level(); k-- > 0;) {
    const bool to_bricks = k + 1 == dag.brick_level();
    std::optional<RankBitmap> below;
    if (!to_bricks) below = dag.node_starts(k + 1);
    out.put(dag.nodes(k));
    dag.for_each_node(k, [&](uint32_t mask, const uint32_t* children) {
      std::array<uint32_t, 8> numbers;
      numbers.fill(kNoChild);
      for (unsigned c = 0, next = 0; c < 8; ++c) {
        if ((mask >> c & 1) == 0) continue;
        const uint32_t child = children[next++];
        numbers[mirrored_child(c)] = to_bricks ? child : below->rank(child);
      }
      out.put(std::as_bytes(std::span(numbers)));
    });
  }
  out.put(uint64_t(dag.bricks().size()));
  for (const Brick brick : dag.bricks()) out.put(mirrored_brick(brick));
  out.put(uint32_t(1) << dag.levels());
  out.put(dag.levels());
  out.put(kTypeDag);
  out.commit();
}

std::unique_ptr<NodeGraph> read_transform_dag(const File& file) {
  return std::make_unique<TransformDagGraph>(file);
}

}  // namespace svdag
