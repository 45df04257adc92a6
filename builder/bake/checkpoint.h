// What of a bake survives its process: a journal in the scratch folder.
//
// Records: the bake (layout of the records, description, grid); the split, if its triangles were
// spilled; every run; the finished bake, if its file waits for colours; the colours of a pass so
// far; every process that resumed the bake. A record is appended only after the data it refers to
// is on disk, so a resumed bake trusts the journal and nothing else (builder/bake/saved_bake.h).
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "builder/bake/saved_bake.h"
#include "builder/build.h"
#include "builder/workspace/workspace.h"

namespace svdag {

class Checkpoint {
 public:
  explicit Checkpoint(Workspace* workspace) : workspace_(workspace) {}

  // Opens the journal and the scratch files of an unfinished bake. Returns nothing, and opens
  // nothing, if the journal holds no bake or one whose description is not wanted. InvalidScratch if
  // the journal is damaged or of another layout.
  std::optional<SavedBake> resume(const std::function<bool(const std::string&)>& wanted);

  // The unfinished bake of an earlier process, if `unfinished` resumes it. Otherwise the scratch
  // folder is empty afterwards. Error (kUsage) for one that must neither be resumed nor discarded.
  std::optional<SavedBake> find(const std::string& output, Unfinished unfinished,
                                const std::function<std::string()>& description);
  // work(); an error also says whether --resume can continue. `resumed`: something was found.
  void run(bool resumed, const std::function<void()>& work) const;

  // Begins a journal, unless there is one. Without a journal nothing is saved.
  void begin(const std::string& description, const Grid& grid);
  bool begun() const { return journal_.has_value(); }
  // Save spilled data, and keep the scratch folder from then on. One call at a time.
  void save_split(const SplitScene& split);
  void save_run(const BakedRun& baked);
  // The bake is complete in its own file; what was spilled for it is removed.
  void save_baked(const SplitCounts& counts);
  // All cubes before the code `end` have their colours; the last of them in `entries`.
  void save_colours(uint64_t end, const SpillStream& entries);
  // Whether --resume would find saved work. From any thread.
  bool has_saved_work() const { return has_saved_work_; }

  // Removes the journal, if any, durably: no power failure restores it beside files that were
  // removed or created since. The scratch folder is no longer kept.
  void discard();

 private:
  void append(SavedKind kind, const RecordWriter& record);

  Workspace* workspace_;
  std::optional<Journal> journal_;
  std::atomic<bool> has_saved_work_{false};
};

}  // namespace svdag
