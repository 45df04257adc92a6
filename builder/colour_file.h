// Adds colours to a `.svdag`, except for the format in which they are written.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "builder/colours/colour_pass.h"
#include "io/dag/colours/colour_writer.h"

namespace svdag {

struct ColourFileConfig {
  std::string file;   // path of a .svdag
  SceneConfig scene;  // that it was built of
  ColourPassConfig pass;
  std::string output;   // path of the file with colours
  uint64_t memory = 0;  // --memory in bytes; 0: half of the machine
  std::string scratch;  // --scratch: parent of the scratch folder; empty: the output's folder
};

// Writes the file with colours of colour level `level`. The output's path names the old file until
// it returns.
using WriteColoured = std::function<void(const DagFile& file, int level,
                                         const CubeColourSource& source, const WorkRoom& room)>;

// The scene is placed as the file says, so --transform, --up and --scale need not be given again;
// if they are, they must be the same. Errors: kUsage for a file without a union, whose colours
// would belong to no root, and for a level that is not kMinColourLevel .. L; kBadInput as
// colour_cubes(), and if a file of the scene changes meanwhile.
ColourPassReport colour_file(const ColourFileConfig& config, const WriteColoured& write,
                             Executor* executor, Progress* progress);

}  // namespace svdag
