#include "streaming/file/command_files.h"

#include <sys/stat.h>

#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/file.h"

namespace svdag {
namespace {

// "DEVICE:INODE" of the file; empty if it does not exist.
std::string inode_key(const std::string& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) return {};
  return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

// Key of the directory entry that an output `name` replaces: device and inode of the folder, and
// the last path component, of where a symbolic link points; the path if the folder does not exist.
// Two hard links to one file have different keys.
std::string directory_entry_key(const std::string& name) {
  const std::string path = output_target(name);
  const std::string folder = inode_key(folder_of(path));
  return folder.empty() ? path : folder + "/" + base_name(path);
}

}  // namespace

bool CommandFiles::read(const std::string& path) {
  const std::string file = inode_key(path);
  const bool known = !file.empty() && !inputs_.insert(file).second;
  return inputs_.insert(directory_entry_key(path)).second && !known;
}

void CommandFiles::read(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) read(path);
}

void CommandFiles::write(const std::string& path) {
  const std::string entry = directory_entry_key(path);
  if (inputs_.contains(entry) || inputs_.contains(inode_key(path)))
    fail_usage(path + " is also an input, which is never overwritten: choose another output");
  if (!outputs_.insert(entry).second)
    fail_usage(path + " would be written twice: choose another name for one of the results");
}

}  // namespace svdag
