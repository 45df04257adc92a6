// The spill files of a bake, created on first use.
//
// Three files with different lifetimes: `triangles` and `runs` hold what a resumed bake needs,
// until the output is complete; the content of `passing` is temporary, and its blocks are reused.
// Stream numbers are unique across all three.
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
  static constexpr uint64_t kLargestBlock = uint64_t(1) << 18;

  // Sizes blocks so that a thousand of them take a quarter of the budget.
  Scratch(ScratchDir* folder, MemoryBudget* budget);

  ScratchDir* folder() const { return folder_; }
  MemoryBudget* budget() const { return budget_; }
  size_t block_bytes() const { return block_bytes_; }
  // Whether this is a valid block size of a scratch or a plan.
  static bool can_have_blocks_of(uint64_t bytes);

  // The names of files that a journal may refer to are synced when the files are created.
  SpillFile* triangles() { return file(&triangles_, "triangles"); }
  SpillFile* runs() { return file(&runs_, "runs"); }
  SpillFile* passing() { return file(&passing_, "passing"); }
  // The first of `count` new stream numbers.
  uint64_t new_streams(uint64_t count = 1) { return next_stream_.fetch_add(count); }

  // Opens the files of an earlier process, with its block size and blocks in use; new streams are
  // numbered from `next_stream`. SpoiledScratch if a file is missing or too short.
  void resume(size_t block_bytes, uint32_t triangle_blocks, uint32_t run_blocks,
              uint64_t next_stream);

  // Sums over the files so far, in bytes: their largest sizes, written, read.
  uint64_t peak_bytes() const { return sum(&SpillFile::peak_bytes); }
  uint64_t written_bytes() const { return sum(&SpillFile::written_bytes); }
  uint64_t read_bytes() const { return sum(&SpillFile::read_bytes); }

 private:
  SpillFile* file(std::unique_ptr<SpillFile>* file, const char* name);
  std::unique_ptr<SpillFile> earlier(const char* name, uint32_t blocks);
  uint64_t sum(uint64_t (SpillFile::*bytes)() const) const;

  ScratchDir* folder_;
  MemoryBudget* budget_;
  size_t block_bytes_;
  std::mutex mutex_;  // workers may be the first to need a file
  std::unique_ptr<SpillFile> triangles_, runs_, passing_;
  std::atomic<uint64_t> next_stream_{1};
};

}  // namespace svdag
