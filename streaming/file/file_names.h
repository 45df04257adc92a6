// Files by name, whatever they are called: "a", "./a" and a link to it are one file.
//
// A file that is not there yet has a name all the same: it will be the one of that last name in
// that folder. So results can be compared with inputs, and with each other, before they exist.
#pragma once

#include <string>
#include <unordered_map>

namespace svdag {

// The last name in its folder, whatever the folder is called: what a rename to `path` replaces. Two
// links to one file have two.
std::string place_of(const std::string& path);

class FileNames {
 public:
  void add(const std::string& path);
  // The name under which this file was added; null if it was not.
  const std::string* find(const std::string& path) const;

 private:
  std::unordered_map<std::string, std::string> names_;  // by what the system knows a file by
};

}  // namespace svdag
