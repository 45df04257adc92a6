// Checks the entries of the colours against the DAG: which cubes they belong to follows from the
// counts of the nodes. Which of these cubes are uniform does not.
#include "io/dag/colours/dag_colours.h"
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
  if (!EntryWalk(colours, colours.tables()).holds())
    defects.push_back("the directory of the colours does not divide the cubes of the DAG");
  return defects;
}

}  // namespace svdag
