// A temporary folder of a fuzzer, for readers that need file names; removed when the process ends.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <map>
#include <string>

#include "streaming/file/file_folder.h"

namespace svdag {

class OwnFolder {
 public:
  OwnFolder() : folder_(Folder::open_private(make())) {}
  ~OwnFolder() { std::filesystem::remove_all(path()); }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  const std::string& path() const { return folder_.path(); }
  const Folder& folder() const { return folder_; }
  // Writes the bytes to the file of that name. Files stay open, which halves the system calls.
  void write(const std::string& name, std::string_view bytes) {
    auto file = files_.find(name);
    if (file == files_.end()) file = files_.emplace(name, folder_.create(name)).first;
    file->second.write_at(0, std::as_bytes(std::span(bytes)));
    file->second.truncate(bytes.size());
  }

 private:
  static std::string make() {
    namespace fs = std::filesystem;
    const fs::path memory = "/dev/shm";
    const fs::path above = fs::is_directory(memory) ? memory : fs::temp_directory_path();
    std::string path = (above / "svdag-fuzz-XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) std::abort();
    return path;
  }

  Folder folder_;
  std::map<std::string, File> files_;
};

}  // namespace svdag
