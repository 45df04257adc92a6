// The colours of a pass on their way to the writer of a file, in scratch: the pass is then
// complete, and its memory free, before anything is written; and a killed pass has those of before.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "builder/workspace/scratch.h"
#include "io/dag/colours/cube_colour.h"

namespace svdag {

class SpilledColours {
 public:
  static constexpr size_t kEntryBytes = 16;

  explicit SpilledColours(Scratch* scratch) : scratch_(*scratch) {}

  // Begins with the entries of an earlier process.
  void restore(std::vector<SpillStream> streams) { streams_ = std::move(streams); }
  void add(std::span<const CubeColour> entries);
  // The entries since the last cut, which are durable once the scratch's `runs` are synced.
  SpillStream cut();
  // The next entries, valid until the next call; empty at the end. None is added after the last
  // cut.
  std::span<const CubeColour> next();

 private:
  Scratch& scratch_;
  std::vector<SpillStream> streams_;  // in order
  size_t next_ = 0;                   // stream to be read
  std::optional<SpillWriter> writer_;
  std::optional<SpillReader> reader_;
  std::vector<CubeColour> entries_;
};

}  // namespace svdag
