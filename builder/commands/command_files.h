// The files of a command: no output overwrites an input or another output.
//
// An input is identified under all its names. An output is a new file that gets its name by a
// rename, even where a link to another output was, so only its path counts. All inputs are added
// before the first output. Only read_buffers() opens files.
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
  // The files that the scene's own files name: the buffers of glTF. Errors are those of the reader.
  void read_buffers(const SceneConfig& scene, uint64_t memory);
  // The files of a plan, and those that it was made of. What `own` makes may be written, at its
  // place in the plan.
  void read(const Plan& plan, const PlanStep* own = nullptr);
  // Error (kUsage) if it is an input, or an output already.
  void write(const std::string& path);

 private:
  FileNames inputs_;
  std::unordered_set<std::string> outputs_;  // their places
};

}  // namespace svdag
