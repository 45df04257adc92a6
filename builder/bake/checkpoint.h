// What of a bake survives its process: a journal in the scratch folder.
//
// Records: what is being baked (the layout of the records, its description and its grid); the
// split, if its triangles were spilled; every run; every process that resumed. A record is appended
// after what it speaks of is on disk, so a bake that is resumed trusts the journal and nothing else
// (builder/bake/saved_bake.h).
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "builder/bake/saved_bake.h"
#include "builder/workspace/scratch.h"

namespace svdag {

class Checkpoint {
 public:
  explicit Checkpoint(Scratch* scratch) : scratch_(scratch) {}

  // Reads the journal, takes the files of the scratch over, and goes on with them. None, and
  // nothing is taken over, if the journal has no bake or one whose description is not wanted;
  // SpoiledScratch if it makes no sense or is of another layout.
  std::optional<SavedBake> resume(const std::function<bool(const std::string&)>& wanted);

  // Removes the journal, if there is one, for good: no power cut brings it back beside files that
  // were removed or made since.
  void discard();
  // Begins a journal, once; without one nothing is saved.
  void begin(const std::string& description, const Grid& grid);
  bool begun() const { return journal_.has_value(); }
  void save_split(const SplitScene& split);
  // Thread-safe.
  void save_run(const BakedRun& baked);

 private:
  void append(SavedKind kind, const RecordWriter& record);

  Scratch* scratch_;
  std::mutex mutex_;
  std::optional<Journal> journal_;
};

}  // namespace svdag
