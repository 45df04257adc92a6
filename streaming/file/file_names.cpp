#include "streaming/file/file_names.h"

#include <sys/stat.h>

#include <vector>

#include "streaming/file/file.h"

namespace svdag {
namespace {

// "DEVICE:INODE" of the file; empty if it does not exist.
std::string inode_key(const std::string& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) return {};
  return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

// Keys of the directory entry and, if it exists, of the file. Paths with a common key name one
// file.
std::vector<std::string> keys_of(const std::string& path) {
  std::vector<std::string> keys = {directory_entry_key(path)};
  std::string file = inode_key(path);
  if (!file.empty()) keys.push_back(std::move(file));
  return keys;
}

}  // namespace

std::string directory_entry_key(const std::string& path) {
  const std::string folder = inode_key(folder_of(path));
  return folder.empty() ? path : folder + "/" + path.substr(path.find_last_of('/') + 1);
}

void FileNames::add(const std::string& path) {
  for (std::string& key : keys_of(path)) names_.emplace(std::move(key), path);
}

const std::string* FileNames::find(const std::string& path) const {
  for (const std::string& key : keys_of(path)) {
    const auto found = names_.find(key);
    if (found != names_.end()) return &found->second;
  }
  return nullptr;
}

}  // namespace svdag
