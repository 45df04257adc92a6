#include "io/dag/colours/kept_colours.h"

#include <algorithm>
#include <array>
#include <vector>

#include "io/colour.h"
#include "io/dag/colours/colour_reader.h"
#include "io/dag/colours/colour_writer.h"

namespace svdag {
namespace {

// Walks the new DAG and the coloured one side by side, depth first.
class KeptCubes {
 public:
  KeptCubes(const DagFile& dag, const DagFile& coloured, const DagColours& colours)
      : dag_(dag.view()),
        from_(colours.view().dag),
        tables_(colours.tables()),
        level_(kept_colour_level(colours.view().level(), dag_.levels)),
        reader_(colours.view(), coloured.header().colour_count) {
    if (!dag_.empty()) stack_.push_back({{}, {}, 0, !from_.empty()});
  }

  uint32_t level() const { return level_; }

  std::span<const CubeColour> next() {
    constexpr size_t kAtOnce = 4096;
    part_.clear();
    while (part_.size() < kAtOnce && !stack_.empty()) step();
    return part_;
  }

 private:
  struct Pair {
    CoveredCube cube;        // of the new DAG
    CoveredCube from;        // the same cube of the coloured one, if it is covered there
    uint64_t number = 0;     // of its first colour
    bool is_stored = false;  // whether it is covered
  };

  void step() {
    const Pair top = stack_.back();
    stack_.pop_back();
    if (!top.is_stored) return add(top.cube, kNoColour, false);
    reader_.advance(top.number);
    const bool is_uniform =
        !reader_.is_chunk() && reader_.entry_end() >= top.number + tables_.of(top.from);
    if (is_uniform || top.cube.level == level_)
      return add(top.cube, reader_.colour(top.number), is_uniform);
    std::array<Pair, 8> children{};
    uint64_t number = top.number + tables_.counts().own(top.from.level);
    for_covered_children(from_, top.from, [&](const CoveredCube& child) {
      children[child.morton & 7] = {{}, child, number, true};
      number += tables_.of(child);
    });
    const size_t first = stack_.size();
    for_covered_children(dag_, top.cube, [&](const CoveredCube& child) {
      Pair pair = children[child.morton & 7];
      pair.cube = child;
      stack_.push_back(pair);
    });
    std::reverse(stack_.begin() + std::ptrdiff_t(first), stack_.end());
  }

  void add(const CoveredCube& cube, uint32_t colour, bool is_constant) {
    CubeColour entry{cube.morton, uint8_t(cube.level), colour != kNoColour, is_constant, {}};
    for (size_t c = 0; c < 3 && entry.has_colour; ++c)
      entry.linear[c] = light16_of_code(uint8_t(colour >> 8 * c));
    part_.push_back(entry);
  }

  const DagView& dag_;
  const DagView& from_;
  const ColourCountTables& tables_;
  const uint32_t level_;
  ColourReader reader_;
  std::vector<Pair> stack_;
  std::vector<CubeColour> part_;
};

}  // namespace

void keep_colours(DagCopy* copy, const DagFile& dag, const DagFile& coloured, bool is_part,
                  const WorkRoom& room, Executor* executor) {
  const DagColours colours(coloured, room.budget);
  KeptCubes cubes(dag, coloured, colours);
  const StoredCubes stored(coloured, colours, is_part && cubes.level() == colours.view().level());
  add_colours(
      copy, dag, {cubes.level(), coloured.header().colour_error}, [&] { return cubes.next(); },
      room, executor, &stored);
}

}  // namespace svdag
