// The colours of a pass on their way to the writer of a file, in scratch: the pass is then
// complete, and its memory free, before anything is written.
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
  explicit SpilledColours(Scratch* scratch) : scratch_(*scratch) {}

  void add(std::span<const CubeColour> entries);
  // No entry is added afterwards.
  void finish();
  // The next entries, valid until the next call; empty at the end.
  std::span<const CubeColour> next();

 private:
  Scratch& scratch_;
  std::optional<SpillWriter> writer_;
  std::optional<SpillReader> reader_;
  std::vector<CubeColour> entries_;
};

}  // namespace svdag
