// The scratch files of a bake, each created when it is first needed.
//
// Three files with different lifetimes: `triangles` and `runs` hold what a resumed bake needs, and
// keep it until the output is complete; data in `transient` is short-lived and its blocks are
// reused. Stream numbers are unique across all three.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "streaming/memory/memory_budget.h"
#include "streaming/spill/scratch_dir.h"
#include "streaming/spill/spill_file.h"

namespace svdag {

class Scratch {
 public:
  static constexpr uint64_t kMaxBlockBytes = uint64_t(1) << 18;

  // Chooses a block size such that a thousand blocks take a quarter of the budget.
  Scratch(ScratchDir* folder, MemoryBudget* budget);

  ScratchDir* folder() const { return folder_; }
  MemoryBudget* budget() const { return budget_; }
  size_t block_bytes() const { return block_bytes_; }
  // Whether `bytes` is a valid block size of a scratch folder (of any budget) or of a plan.
  static bool is_block_size(uint64_t bytes);

  // A file that a journal may refer to is synced to its folder when it is created.
  SpillFile* triangles() { return file(&triangles_, "triangles"); }
  SpillFile* runs() { return file(&runs_, "runs"); }
  SpillFile* transient() { return file(&transient_, "transient"); }
  // Reserves `count` unused stream numbers; returns the first.
  uint64_t new_streams(uint64_t count = 1) { return next_stream_.fetch_add(count); }

  // Continues the files of an earlier process: block size, blocks in use, first unused stream
  // number. InvalidScratch if a file is missing or too short.
  void resume(size_t block_bytes, uint32_t triangle_blocks, uint32_t run_blocks,
              uint64_t next_stream);

  // Removes `triangles` and `runs`, which nothing refers to.
  void remove_saved();

  // Of all files so far: the sum of their largest sizes, and the bytes written and read.
  uint64_t peak_bytes() const { return sum(&SpillFile::peak_bytes); }
  uint64_t written_bytes() const { return sum(&SpillFile::written_bytes); }
  uint64_t read_bytes() const { return sum(&SpillFile::read_bytes); }

 private:
  SpillFile* file(std::unique_ptr<SpillFile>* file, const char* name);
  std::unique_ptr<SpillFile> open_existing(const char* name, uint32_t blocks);
  uint64_t sum(uint64_t (SpillFile::*bytes)() const) const;

  ScratchDir* folder_;
  MemoryBudget* budget_;
  size_t block_bytes_;
  std::mutex mutex_;  // workers may be the first to need a file
  std::unique_ptr<SpillFile> triangles_, runs_, transient_;
  std::atomic<uint64_t> next_stream_{1};
};

}  // namespace svdag
