// The files that a command reads and writes: rejects outputs that overwrite an input or another
// output.
//
// Inputs are compared as files: "a", "./a" and a link to it are one. A file that does not exist yet
// is identified by its folder and its last path component. Outputs are compared as names, through
// symbolic links (output_target): a new file is renamed to the name and replaces a hard link there.
// All inputs are added before the first output. No file is opened.
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

namespace svdag {

class CommandFiles {
 public:
  explicit CommandFiles(const std::vector<std::string>& inputs = {}) { read(inputs); }

  // Adds an input; returns false if the same file was added before.
  bool read(const std::string& path);
  void read(const std::vector<std::string>& paths);
  // Adds an output. Error (kUsage) if `path` is an input or another output.
  void write(const std::string& path);

 private:
  std::unordered_set<std::string> inputs_;   // keys of the files and of their directory entries
  std::unordered_set<std::string> outputs_;  // keys of their directory entries
};

}  // namespace svdag
