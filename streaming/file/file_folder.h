// A folder and the files in it: the other half of the seam of file.h.
//
// All access uses one descriptor of the folder, so a rename or link in the parent folder cannot
// redirect it once it is open. All failures are Errors (kOutput) unless stated otherwise.
#pragma once

#include <sys/stat.h>

#include <string>
#include <vector>

#include "streaming/file/file.h"

namespace svdag {

class Folder {
 public:
  static constexpr const char* kProbe = ".svdag-probe-";

  // Opens the folder, created if necessary, for this user alone (0700). Rejects links, folders of
  // other users and everything that is not a folder.
  static Folder open_private(std::string path);
  // Opens a folder of any owner that others may use, too; creates it (0700) if necessary. A
  // world-writable folder is an Error (kUsage); a link is rejected.
  static Folder open_shared(std::string path);

  Folder(Folder&& other) noexcept;
  Folder(const Folder&) = delete;
  ~Folder();

  const std::string& path() const { return path_; }
  // True if it was made when it was opened: it was empty.
  bool made() const { return made_; }
  // True if there is a regular file of this name.
  bool has(const std::string& name) const;
  // Makes a file (0600) that is not there yet, and opens it for reading and writing.
  File create(const std::string& name) const;
  // Opens a regular file for reading and writing.
  File open(const std::string& name) const;
  // Opens it, or makes it. A File without descriptor if the folder itself was removed meanwhile.
  File open_or_create(const std::string& name) const;
  // Removes a file if it is there.
  void remove(const std::string& name) const;
  std::vector<std::string> names() const;

  // True if `file` is what `name` means in this folder, and this folder what path() means.
  bool holds(const File& file, const std::string& name) const;
  void sync() const;
  // Bytes free on its file system for this user.
  uint64_t free_bytes() const;
  // Removes the folder if it is empty; false if it is not.
  bool remove_itself() const;

 private:
  Folder(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
  static Folder open_or_make(std::string path);
  struct stat status() const;
  // Whether files created in it belong to `owner`: tested with one, named kProbe and a number.
  bool gives_files_to(uid_t owner) const;
  std::string path_of(const std::string& name) const { return path_ + "/" + name; }
  File regular(int fd, const std::string& name) const;

  int fd_;
  std::string path_;
  bool made_ = false;
};

// The path from the root, the links in its folders resolved, but not the last name.
std::string absolute_path(const std::string& path);

}  // namespace svdag
