// The colour pass of a bake or of a file, resumable, and the file that is written of both.
//
// Colours are spilled in Morton order, so a record of the journal is a code and the entries before
// it: what is killed goes on there, once it has read the scene again.
// Rejected: saving the triangles of the pass. They are read again in less time than they are
// coloured, and their bins depend on memory.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "builder/bake/checkpoint.h"
#include "builder/build.h"
#include "io/dag/dag_file.h"
#include "streaming/file/input_watch.h"

namespace svdag {

struct ColourStage {
  const ColourPassConfig& pass;
  const std::string& output;  // path
  double checkpoint;          // seconds
  const DagFile& file;
  const SceneConfig& scene;  // with colours and paint
  const InputWatch& watch;   // of the scene
  // Begins the journal, at the first checkpoint, if there is none yet.
  const std::function<std::string()>& description;
  Workspace* workspace;
  Checkpoint* journal;
  Executor* executor;
  Progress* progress;
};

// Continues `saved`, if it has colours.
ColourReport colour(const ColourStage& stage, std::optional<SavedBake> saved);

}  // namespace svdag
