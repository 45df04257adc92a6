// A set of files. All paths to one file are equal: "a", "./a" and a link to it.
//
// A file that does not exist yet is identified by its folder and its last path component, so
// outputs can be compared with inputs, and with each other, before they are written.
#pragma once

#include <string>
#include <unordered_map>

namespace svdag {

// Key of the directory entry that a rename to `path` replaces: device and inode of the folder, and
// the last path component; `path` itself if the folder does not exist. Two links to one file have
// different keys.
std::string directory_entry_key(const std::string& path);

class FileNames {
 public:
  void add(const std::string& path);
  // Returns the path under which this file was added, or null. Valid until the set is destroyed.
  const std::string* find(const std::string& path) const;

 private:
  std::unordered_map<std::string, std::string> names_;  // paths as added, by the keys of the file
};

}  // namespace svdag
