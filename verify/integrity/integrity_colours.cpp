// Checks the entries of the colours against the DAG: which cubes they belong to follows from the
// counts of the nodes. Which of these cubes are uniform does not. Checks the means of coarser cubes
// against the colours inside, as far as their error allows.
#include <algorithm>
#include <array>
#include <cmath>

#include "io/colour.h"
#include "io/dag/colours/colour_reader.h"
#include "io/dag/colours/dag_colours.h"
#include "io/units.h"
#include "streaming/file/checksum.h"
#include "verify/integrity/integrity.h"

namespace svdag {
namespace {

class EntryWalk {
 public:
  EntryWalk(const DagColours& colours, const ColourCountTables& tables)
      : view_(colours.view()), dag_(view_.dag), tables_(tables) {}

  bool holds() {
    return (dag_.empty() || visit(0, 0)) && entry_ == view_.entry_count &&
           number_ == tables_.total();
  }

 private:
  // The entries of the cube of the node begin at entry_, its colours at number_.
  bool visit(uint32_t level, uint32_t index) {
    const uint64_t count = tables_.of(level, index);
    if (is_at(count)) return true;  // a chunk or a uniform cube
    if (count <= kChunkColours) return false;
    if (view_.counts.own(level) != 0 && (is_chunk() || !is_at(1))) return false;
    bool good = true;
    dag_for_children(dag_, level, index,
                     [&](unsigned, uint32_t child) { good = good && visit(level + 1, child); });
    return good;
  }
  bool is_chunk() const {
    return entry_ < view_.entry_count && (view_.entries[entry_].value & kChunkEntry) != 0;
  }
  // Whether the next entry has this many colours; then goes beyond it.
  bool is_at(uint64_t count) {
    if (entry_ == view_.entry_count || view_.entries[entry_].first != number_) return false;
    const bool is_last = entry_ + 1 == view_.entry_count;
    const uint64_t end = is_last ? tables_.total() : view_.entries[entry_ + 1].first;
    if (end - number_ != count) return false;
    number_ = end;
    ++entry_;
    return true;
  }

  const ColourView& view_;
  const DagView& dag_;
  const ColourCountTables& tables_;
  uint64_t entry_ = 0, number_ = 0;
};

// Between which sums of linear light the true colours of cubes of level K are.
struct LightSum {
  std::array<double, 3> low{}, high{};
  uint64_t count = 0;  // of cubes with a colour

  void add(const LightSum& other) {
    for (size_t c = 0; c < 3; ++c) low[c] += other.low[c], high[c] += other.high[c];
    count += other.count;
  }
};

// The colour before encoding differs from the stored one by at most the error, and by half a step
// more from the light that it was rounded from.
class MeanWalk {
 public:
  // `cubes`: counts without means.
  MeanWalk(const DagColours& colours, const ColourCountTables& cubes, const Header& header)
      : view_(colours.view()),
        tables_(colours.tables()),
        cubes_(cubes),
        reader_(view_, header.colour_count),
        error_(double(header.colour_error) / kColourErrorUnit) {
    for (size_t code = 0; code < light_.size(); ++code) {
      const auto light = [&](double steps) {
        return light_of(std::clamp(double(code) + steps, 0.0, 255.0));
      };
      light_[code] = {light(-error_ - 0.5), light(error_ + 0.5)};
    }
  }

  uint64_t wrong_means() {
    if (!view_.dag.empty()) visit({}, 0);
    return wrong_;
  }

 private:
  LightSum visit(const CoveredCube& cube, uint64_t number) {
    reader_.advance(number);
    const uint64_t end = number + tables_.of(cube);
    if (!reader_.is_chunk() && reader_.entry_end() >= end)
      return light_in(reader_.colour(number), cubes_.of(cube));  // uniform
    if (cube.level == view_.level()) return light_in(reader_.colour(number), 1);
    const bool has_mean = tables_.counts().own(cube.level) != 0;
    const uint32_t mean = has_mean ? reader_.colour(number) : 0;
    LightSum sum;
    number += has_mean;
    for_covered_children(view_.dag, cube, [&](const CoveredCube& child) {
      sum.add(visit(child, number));
      number += tables_.of(child);
    });
    if (has_mean && !is_possible(mean, sum)) ++wrong_;
    return sum;
  }
  LightSum light_in(uint32_t colour, uint64_t cubes) const {
    LightSum sum;
    if (colour == kNoColour) return sum;
    for (size_t c = 0; c < 3; ++c) {
      const auto& [low, high] = light_[colour >> 8 * c & 255];
      sum.low[c] = low * double(cubes), sum.high[c] = high * double(cubes);
    }
    sum.count = cubes;
    return sum;
  }
  bool is_possible(uint32_t mean, const LightSum& sum) const {
    if (mean == kNoColour || sum.count == 0) return (mean == kNoColour) == (sum.count == 0);
    for (size_t c = 0; c < 3; ++c) {
      constexpr double kRounding = 1.0 / 65535;  // light has 16 bits
      const auto& [low, high] = light_[mean >> 8 * c & 255];
      const double n = double(sum.count);
      if (high < sum.low[c] / n - kRounding || low > sum.high[c] / n + kRounding) return false;
    }
    return true;
  }

  const ColourView& view_;
  const ColourCountTables& tables_;
  const ColourCountTables& cubes_;
  ColourReader reader_;
  const double error_;
  std::array<std::array<double, 2>, 256> light_;  // [code]: least and greatest
  uint64_t wrong_ = 0;
};

}  // namespace

std::vector<std::string> colour_defects(const DagFile& file, MemoryBudget* budget) {
  std::vector<std::string> defects;
  const Header& h = file.header();
  Hasher128 hasher;
  hasher.update(std::as_bytes(std::span(&h.colour_count, 1)));
  hasher.update(std::as_bytes(std::span(&h.colour_level, 1)));
  hasher.update(std::as_bytes(std::span(&h.colour_error, 1)));
  hasher.update(file.bytes().subspan(h.chunks_offset, h.chunks_bytes));
  hasher.update(file.bytes().subspan(h.directory_offset, h.directory_bytes));
  if (hasher.digest() != Hash128{h.colour_hash[0], h.colour_hash[1]})
    defects.push_back("the colours do not match their hash");
  const DagColours colours(file, budget);
  if (!EntryWalk(colours, colours.tables()).holds()) {
    defects.push_back("the directory of the colours does not divide the cubes of the DAG");
    return defects;
  }
  const ColourCountTables cubes(file.view(), h.colour_level, false, budget);
  if (const uint64_t wrong = MeanWalk(colours, cubes, h).wrong_means(); wrong > 0)
    defects.push_back("the colours of " + format_count(wrong, "coarser cube") +
                      " are not the mean of those inside");
  return defects;
}

}  // namespace svdag
