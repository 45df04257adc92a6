#include "io/formats/dags/symvox.h"

#include <array>
#include <cmath>

#include "io/dag/symvox_header.h"
#include "io/formats/graph_window.h"
#include "io/formats/output.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// The box may be flat: the grid is the cube of side `header.side` around its middle.
double corner_of(const SymvoxHeader& header, int axis) {
  const double middle = (double(header.box_min[axis]) + double(header.box_max[axis])) / 2;
  return middle - double(header.side) / 2;
}

class SymvoxGraph : public NodeGraph {
 public:
  explicit SymvoxGraph(const File& file) : nodes_(file), blocks_(file) {
    if (!read_symvox_header(file, &header_))
      fail_input(file.path(), "is not a SymVox file: its header does not match its size");
    levels_ = checked_levels(file, header_.levels, 28);
    Point min, max;
    for (int a = 0; a < 3; ++a) {
      min[a] = corner_of(header_, a);
      max[a] = min[a] + double(header_.side);
    }
    grid_ = grid_of_box(file, min, max, levels_);
  }

  Grid grid() const override { return grid_; }

  std::array<uint32_t, 8> children(int, uint32_t id) override {
    const uint64_t at = offset(id);
    const uint32_t mask = nodes_.u32(at);
    if (mask > 0xff)
      fail_input(nodes_.path(),
                 "a child mask has more than 8 bits: the file is damaged, or a .ussvdag, whose "
                 "mirrored nodes are not supported",
                 at);
    if (id + uint64_t(popcount8(mask)) >= header_.words)
      fail_input(nodes_.path(), "damaged file: a node is truncated", at);
    std::array<uint32_t, 8> result;
    for (unsigned c = 8, next = 1; c-- > 0;) {
      result[c] = kNoChild;
      if ((mask >> c & 1) == 0) continue;
      result[c] = nodes_.u32(at + 4 * next);
      if (result[c] >= header_.words)
        fail_input(nodes_.path(), "damaged file: a child pointer is out of range", at + 4 * next);
      ++next;
    }
    return result;
  }

  Brick brick(uint32_t id) override {
    const std::array<uint32_t, 8> blocks = children(levels_ - 2, id);
    Brick brick = 0;
    for (unsigned c = 0; c < 8; ++c) {
      if (blocks[c] == kNoChild) continue;
      const uint32_t block = blocks_.u32(offset(blocks[c]));
      if (block > 0xff)
        fail_input(blocks_.path(), "damaged file: a leaf has more than 8 voxels",
                   offset(blocks[c]));
      brick |= Brick(block) << (8 * c);
    }
    return brick;
  }

 private:
  static uint64_t offset(uint32_t id) { return sizeof(SymvoxHeader) + 4 * uint64_t(id); }

  GraphWindow nodes_, blocks_;
  SymvoxHeader header_;
  int levels_;
  Grid grid_;
};

// Assigns consecutive words from `first` on to the masks of 2^3 blocks in use: [mask] is its word,
// or 0.
std::array<uint32_t, 256> assign_block_words(const WholeDag& dag, uint64_t first, uint64_t* end) {
  std::array<uint32_t, 256> word{};
  for (const Brick brick : dag.bricks()) {
    for (int b = 0; b < 64; b += 8) word[brick >> b & 0xff] = 1;
  }
  *end = first;
  word[0] = 0;
  for (uint32_t& w : word) w = w != 0 ? uint32_t((*end)++) : 0;
  return word;
}

// Writes the nodes of the bricks and their blocks; `blocks`: the word of each block mask.
void put_bricks(const WholeDag& dag, const std::array<uint32_t, 256>& blocks, Output* out) {
  for (const Brick brick : dag.bricks()) {
    out->put(brick_octants(brick));
    for (int b = 56; b >= 0; b -= 8) {
      if ((brick >> b & 0xff) != 0) out->put(blocks[brick >> b & 0xff]);
    }
  }
  for (uint32_t mask = 0; mask < 256; ++mask) {
    if (blocks[mask] != 0) out->put(mask);
  }
}

SymvoxHeader header_for(const WholeDag& dag) {
  const Grid grid = dag.grid();
  SymvoxHeader header{};
  const Point corner = grid.corner();
  const double side = double(grid.resolution()) * grid.voxel_size;
  for (int a = 0; a < 3; ++a) {
    header.box_min[a] = float(corner[a]);
    header.box_max[a] = float(corner[a] + side);
  }
  header.side = float(side);
  header.levels = dag.levels();
  bool good = header.side > 0 && std::isfinite(header.side);
  for (int a = 0; a < 3; ++a) {
    good = good && header.box_min[a] < header.box_max[a];
    good = good && std::isfinite(header.box_min[a]) && std::isfinite(header.box_max[a]);
    // The position that a reader computes. svdag-verify accepts up to an eighth of a voxel.
    const double read = corner_of(header, a);
    good = good && std::abs(read - corner[a]) <= grid.voxel_size / 8;
  }
  if (!good)
    fail_usage(
        "SymVox stores the box of a grid as float32, and this box is too large, too small or too "
        "far from zero: export hashdag, which stores float64");
  return header;
}

}  // namespace

void write_symvox(const WholeDag& dag, const std::string& path) {
  SymvoxHeader header = header_for(dag);
  const BlockNumbers blocks_before = dag.blocks_before();
  std::array<uint64_t, kMaxSections> base{};  // [level]: index of its first word
  for (uint32_t k = 0; k < dag.brick_level(); ++k) base[k + 1] = base[k] + dag.words(k);
  const uint64_t first_leaf =
      base[dag.brick_level()] + dag.bricks().size() + blocks_before[dag.bricks().size()];
  uint64_t words = 0;
  const auto blocks = assign_block_words(dag, first_leaf, &words);
  if (words > UINT32_MAX)
    fail_usage("SymVox holds fewer than 2^32 words, this DAG needs " + format_count(words) +
               ": export a coarser --level");
  uint64_t nodes = dag.bricks().size() + (words - first_leaf);
  for (uint32_t k = 0; k < dag.brick_level(); ++k) nodes += dag.nodes(k);
  header.nodes = uint32_t(nodes);
  header.first_leaf = uint32_t(first_leaf);
  header.words = uint32_t(words);

  Output out(path);
  out.put(std::as_bytes(std::span(&header, 1)));
  for (uint32_t k = 0; k < dag.brick_level(); ++k) {
    const uint32_t below = uint32_t(base[k + 1]);
    const bool to_bricks = k + 1 == dag.brick_level();
    const auto word_of = [&](uint32_t child) {
      return below + child + (to_bricks ? blocks_before[child] : 0);
    };
    dag.for_each_node(k, [&](uint32_t mask, const uint32_t* children) {
      out.put(mask);
      for (int i = popcount8(mask); i-- > 0;) out.put(word_of(children[i]));
    });
  }
  put_bricks(dag, blocks, &out);
  out.commit();
}

std::unique_ptr<NodeGraph> read_symvox(const File& file) {
  return std::make_unique<SymvoxGraph>(file);
}

}  // namespace svdag
