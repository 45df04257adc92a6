// A folder and the files in it.
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
  // Opens a folder for this user only: creates it if necessary, and sets its mode to 0700. Rejects
  // links, folders of other users and everything that is not a folder. Its parent must exist.
  static Folder open_private(std::string path);
  // Opens a folder that other users may own and use; creates it (0700) if necessary. Keeps the mode
  // of an existing one. Rejects links. Error (kUsage) if an existing folder is world-writable.
  static Folder open_shared(std::string path);

  Folder(Folder&& other) noexcept;
  Folder(const Folder&) = delete;
  ~Folder();

  const std::string& path() const { return path_; }
  // True if open_private() or open_shared() created the folder, which then was empty.
  bool created() const { return created_; }
  // True if a regular file of this name exists.
  bool has(const std::string& name) const;
  // Creates a file (mode 0600) and opens it for reading and writing. Error if the name exists.
  File create(const std::string& name) const;
  // Opens an existing regular file with a single hard link for reading and writing.
  File open(const std::string& name) const;
  // Opens or creates a file. Returns a File without descriptor (-1) if the folder itself was
  // removed meanwhile.
  File open_or_create(const std::string& name) const;
  // Removes a file, if it exists.
  void remove(const std::string& name) const;
  // Names of all files and folders in it, without "." and "..", in no particular order.
  std::vector<std::string> names() const;

  // True if `name` in this folder still refers to `file`, and path() to this folder.
  bool holds(const File& file, const std::string& name) const;
  // Makes the creation and removal of files durable.
  void sync() const;
  // Free bytes of the file system that this user may use.
  uint64_t free_bytes() const;
  // Removes the folder if it is empty; returns false if it is not.
  bool remove_itself() const;

 private:
  Folder(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
  static Folder open_or_create_folder(std::string path);
  struct stat status() const;
  // True if a new file in the folder, which is removed at once, belongs to `owner`.
  bool new_files_belong_to(uid_t owner) const;
  std::string path_of(const std::string& name) const { return path_ + "/" + name; }
  File regular(int fd, const std::string& name) const;

  int fd_;
  std::string path_;
  bool created_ = false;
};

// Bytes that this user can still write to files in `folder`; 0 if no file can be created, and
// UINT64_MAX if that is unknown: writing a file will report why.
uint64_t free_bytes_of(const std::string& folder);

// Whether an existing `path`, all symbolic links resolved, is in the folder or below it.
bool is_inside(const std::string& folder, const std::string& path);

// `path` as an absolute path with the symbolic links of its folder resolved, but not a link that is
// the last component.
std::string absolute_path(const std::string& path);

}  // namespace svdag
