// The files of a command: what it reads is never overwritten, and no result by another one.
//
// All inputs are told before the first output. Nothing is opened but by read_buffers().
#pragma once

#include <string>
#include <vector>

#include "io/scene/scene.h"
#include "streaming/file_names.h"

namespace svdag {

class CommandFiles {
 public:
  void read(const std::string& path) { inputs_.add(path); }
  void read(const std::vector<std::string>& paths);
  // The files that the scene's own files name: the buffers of glTF. Errors are those of the reader.
  void read_buffers(const SceneConfig& scene, uint64_t memory);
  // Error (kUsage) if it is an input, or an output already.
  void write(const std::string& path);

 private:
  FileNames inputs_, outputs_;
};

}  // namespace svdag
