// A `.run` opened for reading: its header, part and roots, and its levels as streams.
//
// open() proves that the header is sound, that the counts in it are those of a file of this size,
// and that part and roots belong together. The levels are proven by check_run()
// (builder/run/run_check.h), in one pass; who streams them before that finds damage (every block is
// checked again), but must not follow a rank. All that is wrong is an Error (kBadInput) that names
// the file and the place.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "builder/octree/grid_part.h"
#include "builder/octree/sub_dag_root.h"
#include "builder/run/run_format.h"
#include "io/dag/format.h"
#include "streaming/file/file.h"
#include "streaming/file/input_watch.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/spill/block_source.h"

namespace svdag {

class RunFile {
 public:
  // `watch`, if given, records the file.
  static RunFile open(const std::string& path, MemoryBudget* budget, InputWatch* watch = nullptr);

  const std::string& path() const { return file_.path(); }
  const File& file() const { return file_; }
  const RunHeader& header() const { return header_; }
  const RunLayout& layout() const { return layout_; }
  Grid grid() const;
  Rule rule() const { return Rule(header_.rule); }
  const GridPart& part() const { return part_; }
  // In Morton order; `run` is 0 in them.
  const std::vector<SubDagRoot>& roots() const { return roots_; }
  uint64_t keys(int level) const { return header_.keys[level]; }
  // The keys of `level` as bytes; the run must outlive the source.
  std::unique_ptr<BlockSource> read(int level, MemoryBudget* budget) const;

 private:
  RunFile(File file, const RunHeader& header, MemoryBudget* budget);
  void read_part(MemoryBudget* budget);
  void read_roots(MemoryBudget* budget);

  File file_;
  RunHeader header_;
  RunLayout layout_;
  MemoryBudget::Reservation counted_;  // part and roots
  GridPart part_;
  std::vector<SubDagRoot> roots_;
};

// Reads a section block by block. Holds one block: the file is read in order, so the system reads
// ahead.
class RunReader final : public BlockSource {
 public:
  RunReader(const File& file, const RunHeader& header, const RunSection& section,
            MemoryBudget* budget);

  std::span<std::byte> next() override;
  // Checksum of the block that next() gave out last.
  uint64_t checksum() const { return checksum_; }

 private:
  const File& file_;
  uint64_t run_;
  uint64_t payload_;  // of the file
  RunSection left_;
  SpillBlock block_;
  uint64_t checksum_ = 0;
};

// Error (kBadInput) "damaged run: SENTENCE" unless `condition`.
void require_run(bool condition, const File& file, const char* sentence, uint64_t offset);

}  // namespace svdag
