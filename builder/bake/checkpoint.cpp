#include "builder/bake/checkpoint.h"

#include <utility>

#include "streaming/spill/scratch_dir.h"

namespace svdag {
namespace {

constexpr int kSessionShift = 40;  // log2 of the stream numbers of one process

// Parses what was read before, so any Error means an invalid journal.
SavedBake parse(const std::vector<JournalRecord>& records, const std::string& path) {
  try {
    return read_saved(records, path);
  } catch (const Error& error) {
    throw InvalidScratch(error);
  }
}

}  // namespace

std::optional<SavedBake> Checkpoint::resume(const std::function<bool(const std::string&)>& wanted) {
  std::vector<JournalRecord> records;
  ScratchDir* const folder = workspace_->folder();
  folder->keep();  // also if it cannot be read now
  Journal journal(folder->open(kJournalName), &records);
  SavedBake saved = parse(records, folder->path() + "/" + kJournalName);
  if (saved.block_bytes == 0 || !wanted(saved.description)) return {};
  // A killed process may leave blocks with stream numbers that are not in the journal, so each
  // process has its own range of numbers.
  workspace_->scratch()->resume(size_t(saved.block_bytes), saved.triangle_blocks, saved.run_blocks,
                                (saved.sessions + 1) << kSessionShift);
  journal.append(uint32_t(SavedKind::kSession), RecordWriter().bytes());
  journal_.emplace(std::move(journal));
  has_saved_work_ = true;
  return saved;
}

void Checkpoint::begin(const std::string& description, const Grid& grid) {
  if (journal_) return;
  ScratchDir* const folder = workspace_->folder();
  std::vector<JournalRecord> none;
  Journal journal(folder->create(kJournalName), &none);
  journal.append(uint32_t(SavedKind::kBake),
                 bake_record(description, grid, workspace_->scratch()->block_bytes()).bytes());
  folder->sync();
  folder->sync_itself();
  journal_.emplace(std::move(journal));  // last: nothing is appended before the first record
}

void Checkpoint::save_split(const SplitScene& split) {
  workspace_->scratch()->triangles()->sync();
  append(SavedKind::kSplit, split_record(split));
}

void Checkpoint::save_run(const BakedRun& baked) {
  workspace_->scratch()->runs()->sync();
  append(SavedKind::kRun, run_record(baked));
}

void Checkpoint::append(SavedKind kind, const RecordWriter& record) {
  journal_->append(uint32_t(kind), record.bytes());
  workspace_->folder()->keep();
  has_saved_work_ = true;
}

void Checkpoint::discard() {
  has_saved_work_ = false;
  workspace_->folder()->keep(false);
  journal_.reset();
  if (!workspace_->has_unfinished_bake()) return;
  workspace_->folder()->remove(kJournalName);
  workspace_->folder()->sync();
}

}  // namespace svdag
