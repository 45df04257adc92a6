#include "builder/bake/checkpoint.h"

#include <utility>

#include "builder/workspace/workspace.h"
#include "streaming/spill/spoiled_scratch.h"

namespace svdag {
namespace {

constexpr int kSessionShift = 40;  // numbers of streams that a session may use, log2

// Only what was read is looked at, so any Error is about that.
SavedBake read_or_spoiled(const std::vector<JournalRecord>& records, const std::string& path) {
  try {
    return read_saved(records, path);
  } catch (const Error& error) {
    throw SpoiledScratch(error);
  }
}

}  // namespace

std::optional<SavedBake> Checkpoint::resume(const std::function<bool(const std::string&)>& wanted) {
  std::vector<JournalRecord> records;
  Journal journal(scratch_->folder()->open(kJournalName), &records);
  SavedBake saved = read_or_spoiled(records, scratch_->folder()->path() + "/" + kJournalName);
  if (saved.block_bytes == 0 || !wanted(saved.description)) return {};
  // Blocks that a killed process left behind carry numbers that are not in the journal: each
  // session has numbers of its own.
  scratch_->resume(size_t(saved.block_bytes), saved.triangle_blocks, saved.run_blocks,
                   (saved.sessions + 1) << kSessionShift);
  journal.append(uint32_t(SavedKind::kSession), RecordWriter().bytes());
  journal_.emplace(std::move(journal));
  return saved;
}

void Checkpoint::discard() {
  journal_.reset();
  if (!scratch_->folder()->has(kJournalName)) return;
  scratch_->folder()->remove(kJournalName);
  scratch_->folder()->sync();
}

void Checkpoint::begin(const std::string& description, const Grid& grid) {
  const std::lock_guard lock(mutex_);
  if (journal_) return;
  std::vector<JournalRecord> none;
  Journal journal(scratch_->folder()->create(kJournalName), &none);
  journal.append(uint32_t(SavedKind::kBake),
                 bake_record(description, grid, scratch_->block_bytes()).bytes());
  scratch_->folder()->sync();
  scratch_->folder()->sync_itself();
  journal_.emplace(std::move(journal));  // last: nothing is appended to one that has not begun
}

void Checkpoint::save_split(const SplitScene& split) {
  scratch_->triangles()->sync();
  append(SavedKind::kSplit, split_record(split));
}

void Checkpoint::save_run(const BakedRun& baked) {
  scratch_->runs()->sync();
  append(SavedKind::kRun, run_record(baked));
}

void Checkpoint::append(SavedKind kind, const RecordWriter& record) {
  const std::lock_guard lock(mutex_);
  journal_->append(uint32_t(kind), record.bytes());
}

}  // namespace svdag
