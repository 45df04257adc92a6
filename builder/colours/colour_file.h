// Adds colours to a `.svdag`: the work of `svdag colour`, but for the format of what is written.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "builder/colours/colour_pass.h"

namespace svdag {

struct ColourFileConfig {
  std::string file;   // path of a .svdag
  SceneConfig scene;  // that it was built of
  ColourPassConfig pass;
  std::string output;   // path of the file with colours
  uint64_t memory = 0;  // --memory in bytes; 0: half of the machine
  std::string scratch;  // --scratch: parent of the scratch folder; empty: the output's folder
};

// Writes the file with colours. The output's path names the old file until finish() has returned;
// without finish() nothing is left.
class ColourOutput {
 public:
  virtual ~ColourOutput() = default;
  // Adds the next entries of the sequence (io/dag/colours/cube_colour.h).
  virtual void add(std::span<const CubeColour> entries) = 0;
  virtual void finish() = 0;
};

// Opens the output: of the colours of `file` at colour level `level`.
using OpenColourOutput = std::function<std::unique_ptr<ColourOutput>(
    const DagFile& file, int level, const ColourFileConfig& config, Workspace* workspace)>;

// The scene is placed as the file says, so --transform, --up and --scale need not be given again;
// if they are, they must be the same. Errors: kUsage for a file without a union, whose colours
// would belong to no root, and for a level that is not kMinColourLevel .. L; kBadInput as
// colour_cubes(), and if a file of the scene changes meanwhile.
ColourPassReport colour_file(const ColourFileConfig& config, const OpenColourOutput& open,
                             Executor* executor, Progress* progress);

}  // namespace svdag
