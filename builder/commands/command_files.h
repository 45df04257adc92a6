// The files that a command reads and writes: rejects outputs that overwrite an input or another
// output.
//
// Inputs are compared as files, under all their names. Outputs are compared as paths: a new file
// is renamed to the path and replaces a link there. All inputs are added before the first output.
// Only read_buffers() opens files.
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "builder/farm/plan/plan.h"
#include "io/scene/scene.h"
#include "streaming/file/file_names.h"

namespace svdag {

class CommandFiles {
 public:
  void read(const std::string& path) { inputs_.add(path); }
  void read(const std::vector<std::string>& paths);
  // Adds the files that the scene's files refer to: buffers of glTF. Throws the errors of the
  // reader.
  void read_buffers(const SceneConfig& scene, uint64_t memory);
  // Adds the files and the inputs of a plan, except for the output of `own`: that step may write
  // it, at its path in the plan.
  void read(const Plan& plan, const PlanStep* own = nullptr);
  // Adds an output. Error (kUsage) if `path` is an input or another output.
  void write(const std::string& path);

 private:
  FileNames inputs_;
  std::unordered_set<std::string> outputs_;  // keys of their directory entries
};

}  // namespace svdag
