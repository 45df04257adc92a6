// What a bake spills to, made when it is first needed.
//
// Three files with different lives: `triangles` and `runs` hold what a resumed bake builds upon and
// keep it until the output is there; what is in `passing` is used up soon, and its blocks are used
// again. Streams are numbered through all of them.
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
  // Whether the blocks of a scratch, of any budget, or of a plan can have this size.
  static bool can_have_blocks_of(uint64_t bytes);

  // A file that a journal may speak of has its name on disk from the beginning.
  SpillFile* triangles() { return file(&triangles_, "triangles"); }
  SpillFile* runs() { return file(&runs_, "runs"); }
  SpillFile* passing() { return file(&passing_, "passing"); }
  // `count` numbers of streams that nobody has had.
  uint64_t new_streams(uint64_t count = 1) { return next_stream_.fetch_add(count); }

  // Continues the files of an earlier process: block size, blocks in use, and numbers not used yet.
  // SpoiledScratch if one is missing or too short.
  void resume(size_t block_bytes, uint32_t triangle_blocks, uint32_t run_blocks,
              uint64_t next_stream);

  // Of the folder so far: the largest size of its files, and bytes written and read.
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
