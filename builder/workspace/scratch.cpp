#include "builder/workspace/scratch.h"

#include <algorithm>
#include <bit>

#include "streaming/error.h"
#include "streaming/spill/scratch_dir.h"

namespace svdag {
namespace {

constexpr uint64_t kMinBlockBytes = uint64_t(1) << 14;

}  // namespace

Scratch::Scratch(ScratchDir* folder, MemoryBudget* budget)
    : folder_(folder),
      budget_(budget),
      block_bytes_(
          std::bit_floor(std::clamp(budget->limit() / 4096, kMinBlockBytes, kMaxBlockBytes))) {}

bool Scratch::is_block_size(uint64_t bytes) {
  return std::has_single_bit(bytes) && bytes >= SpillBlock::kAlignment && bytes <= kMaxBlockBytes;
}

SpillFile* Scratch::file(std::unique_ptr<SpillFile>* file, const char* name) {
  const std::lock_guard lock(mutex_);
  if (!*file) {
    *file = std::make_unique<SpillFile>(folder_->create(name), block_bytes_);
    if (file != &transient_) folder_->sync();
  }
  return file->get();
}

std::unique_ptr<SpillFile> Scratch::open_existing(const char* name, uint32_t blocks) {
  if (blocks == 0) return nullptr;
  const auto require = [&](bool condition, const char* sentence) {
    if (!condition)
      throw InvalidScratch(ExitCode::kOutput,
                           std::string("file \"") + name + "\" is " + sentence +
                               ": discard the unfinished bake with --restart",
                           folder_->path());
  };
  require(folder_->has(name), "missing");
  File file = folder_->open(name);
  require(file.size() / block_bytes_ >= blocks, "truncated");  // the file holds whole blocks only
  return std::make_unique<SpillFile>(std::move(file), block_bytes_, blocks);
}

void Scratch::resume(size_t block_bytes, uint32_t triangle_blocks, uint32_t run_blocks,
                     uint64_t next_stream) {
  block_bytes_ = block_bytes;
  next_stream_ = next_stream;
  triangles_ = open_existing("triangles", triangle_blocks);
  runs_ = open_existing("runs", run_blocks);
}

void Scratch::remove_saved() {
  const std::lock_guard lock(mutex_);
  triangles_.reset();
  runs_.reset();
  folder_->remove("triangles");
  folder_->remove("runs");
}

uint64_t Scratch::sum(uint64_t (SpillFile::*bytes)() const) const {
  uint64_t total = 0;
  for (const auto* file : {&triangles_, &runs_, &transient_}) {
    if (*file) total += (file->get()->*bytes)();
  }
  return total;
}

}  // namespace svdag
