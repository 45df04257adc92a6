// Adds colours to a `.svdag`: the pass over its scene, and the file that is written of both.
#pragma once

#include <cstdint>
#include <string>

#include "builder/build.h"

namespace svdag {

struct ColourFileConfig {
  std::string file;   // path of a .svdag
  SceneConfig scene;  // that it was built of
  ColourPassConfig pass;
  std::string output;   // path of the file with colours
  uint64_t memory = 0;  // --memory in bytes; 0: half of the machine
  std::string scratch;  // --scratch: parent of the scratch folder; empty: the output's folder
  Unfinished unfinished = Unfinished::kRefuse;  // --resume, --restart
  double checkpoint = kCheckpointSeconds;       // max seconds of work that a killed pass loses
};

// The output's path names the old file until the new one is complete. The scene is placed as the
// file says, so --transform, --up and --scale need not be given again; if they are, they must be
// the same. Errors: kUsage for a file without a union, whose colours would belong to no root, and
// for a level that is not kMinColourLevel .. L; kBadInput as colour_cubes(), and if a file of the
// scene changes meanwhile.
ColourReport colour_file(const ColourFileConfig& config, Executor* executor, Progress* progress);

}  // namespace svdag
