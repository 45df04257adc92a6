// A `.run` opened for reading: its header, part and roots, and its levels as streams.
//
// open() checks that the header is valid, that its counts match the size of the file, and that the
// roots are tops of the part. check_run() (builder/run/run_check.h) checks the levels, in one pass.
// Before that, a reader of the levels detects damage (every block is verified when it is read) but
// must not follow a rank. Every fault is an Error (kBadInput) with the file and the offset.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "builder/octree/grid_part.h"
#include "builder/octree/sub_dag_root.h"
#include "builder/run/run_format.h"
#include "io/dag/format.h"
#include "io/dag/layers/layer_table.h"
#include "streaming/file/file.h"
#include "streaming/file/input_watch.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/spill/spill_block.h"

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
  // In Morton order, with `run` = 0, each of one set.
  const std::vector<SubDagRoot>& roots() const { return roots_; }
  // Empty in a run without layers; its layers have no roots.
  const LayerTable& layers() const { return layers_; }
  uint64_t key_count(int level) const { return header_.keys[level]; }
  // Streams the keys of `level` as bytes. The run must outlive the source.
  std::unique_ptr<BlockSource> read(int level, MemoryBudget* budget) const;

 private:
  RunFile(File file, const RunHeader& header, MemoryBudget* budget);
  void read_part(MemoryBudget* budget);
  void read_roots(MemoryBudget* budget);
  void read_layers(MemoryBudget* budget);

  File file_;
  RunHeader header_;
  RunLayout layout_;
  MemoryBudget::Reservation counted_;  // part and roots
  GridPart part_;
  std::vector<SubDagRoot> roots_;
  LayerTable layers_;
};

// Reads a section block by block, holding one block. The file is read in order, so the operating
// system reads ahead.
class RunReader final : public BlockSource {
 public:
  RunReader(const File& file, const RunHeader& header, const RunSection& section,
            MemoryBudget* budget);

  std::span<std::byte> next() override;
  // Checksum of the block that next() returned last.
  uint64_t checksum() const { return checksum_; }

 private:
  const File& file_;
  uint64_t run_;
  uint64_t payload_;  // size, in bytes
  RunSection left_;
  SpillBlock block_;
  uint64_t checksum_ = 0;
};

// Error (kBadInput) "damaged run: SENTENCE" unless `condition`.
void require_run(bool condition, const File& file, const char* sentence, uint64_t offset);

}  // namespace svdag
