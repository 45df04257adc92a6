#include "builder/bake/checkpoint.h"

#include <utility>

#include "builder/bake/description.h"
#include "streaming/process/interrupt.h"
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

std::optional<SavedBake> Checkpoint::find(const std::string& output, Unfinished unfinished,
                                          const std::function<std::string()>& description) {
  std::optional<SavedBake> saved;
  if (workspace_->has_unfinished_bake()) {
    const auto wanted = [&](const std::string& text) {
      return unfinished != Unfinished::kResumeSame || text == description();
    };
    if (unfinished != Unfinished::kRestart) saved = resume(wanted);
    if (saved && !saved->has_work()) saved.reset();
    if (!saved) discard();
  }
  if (!saved) {
    workspace_->folder()->clear();
    return saved;
  }
  if (unfinished == Unfinished::kRefuse)
    fail_usage(output + ": an unfinished bake of it is in " + workspace_->folder()->path() +
               ": continue it with --resume or discard it with --restart");
  const std::string other = difference(saved->description, description());
  if (!other.empty())
    fail_usage(output + ": the unfinished bake is another one: " + other +
               "; discard it with --restart");
  return saved;
}

void Checkpoint::run(bool resumed, const std::function<void()>& work) const {
  const std::string hint = std::string("; what is done so far is kept for --resume") +
                           (resumed ? ", --restart begins anew" : "");
  try {
    work();
  } catch (Interrupted& interrupted) {
    interrupted.resumable = has_saved_work();
    throw;
  } catch (const InvalidScratch&) {  // there is nothing to resume
    throw;
  } catch (const Error& error) {
    if (!has_saved_work() || error.code() == ExitCode::kInternal) throw;
    throw error.with_hint(hint);
  } catch (const std::exception& error) {
    if (!has_saved_work() || !is_lack_of_memory(error)) throw;
    throw Error(ExitCode::kMemory, kNoMemory + hint);
  }
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

void Checkpoint::save_baked(const SplitCounts& counts) {
  append(SavedKind::kBaked, baked_record(counts));
  workspace_->scratch()->remove_saved();
}

void Checkpoint::save_colours(uint64_t end, const SpillStream& entries) {
  workspace_->scratch()->runs()->sync();
  append(SavedKind::kColours, colours_record(end, entries));
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
