// The private folder for the spilled data of one bake.
//
// It is OUT.svdag.scratch/ beside the output, or a folder under --scratch DIR, with mode 0700. Its
// owner is the process that holds the flock on its file `owner`. A lock ends with its process, so
// the folder of a killed owner can be taken over at once, and a running owner's never. Files in
// it are created with O_EXCL | O_NOFOLLOW, mode 0600: planted files and links are neither followed
// nor written to.
// Rejected: process ids as locks (they are reused), names under /tmp (shared, often in memory).
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "streaming/error.h"
#include "streaming/file/file.h"
#include "streaming/file/file_folder.h"

namespace svdag {

// Another process owns the folder. kUsage, because usually a bake was started twice by mistake; a
// farm may retry later.
class ScratchInUse : public Error {
 public:
  explicit ScratchInUse(const std::string& path)
      : Error(ExitCode::kUsage, "another bake is using this scratch folder: wait for it, or end it",
              path) {}
};

// The Error for a scratch folder whose content cannot be resumed: it is damaged, or of another
// version of svdag. A caller that may discard it starts over. A full or failing disk is a plain
// Error, because the work can be resumed later.
class InvalidScratch : public Error {
 public:
  using Error::Error;
  explicit InvalidScratch(const Error& error) : Error(error) {}
};

class ScratchDir {
 public:
  // Path of the folder for `output`: OUTPUT.scratch or, if `under` is not empty, a folder in
  // `under` named after the output and a hash of its absolute path, so that many bakes may share
  // `under`. A name of more than 255 bytes is shortened and gets the hash, too.
  static std::string path_for(const std::string& output, const std::string& under);

  // True if a process owns the folder `path` now.
  static bool in_use(const std::string& path);

  // Creates the folder, or takes over an existing one with its files. Throws ScratchInUse if
  // another process owns it; Error (kOutput) if it cannot be created, is a link, is not a folder,
  // belongs to another user, or has files but no lock.
  explicit ScratchDir(const std::string& path);
  ScratchDir(const ScratchDir&) = delete;
  ScratchDir& operator=(const ScratchDir&) = delete;
  // Removes the folder, unless keep() was called, and releases the lock.
  ~ScratchDir();

  const std::string& path() const { return folder_.path(); }
  // True if a regular file of this name exists.
  bool has(const std::string& name) const { return folder_.has(name); }
  // Creates a file, replacing one of that name, and opens it for reading and writing.
  File create(const std::string& name);
  // Opens an existing file for reading and writing.
  File open(const std::string& name) { return folder_.open(name); }
  // Path of a file that another writer creates in the folder, which is removed like its own.
  std::string path_of(const std::string& name);
  // Removes a file, if it exists.
  void remove(const std::string& name);
  // Removes all files except the lock.
  void clear();
  // Makes the creation and removal of files durable.
  void sync() const { folder_.sync(); }
  // Makes the creation of the folder durable.
  void sync_itself() const { sync_folder(folder_of(path())); }
  // Sets whether the destructor keeps the folder, because its content can be resumed.
  void keep(bool kept = true) { kept_ = kept; }

  // Free bytes of the file system that this user may use.
  uint64_t free_bytes() const { return folder_.free_bytes(); }

 private:
  static Folder acquire(const std::string& path, File* lock);
  template <class Action>
  static bool attempt(const Action& action) noexcept;
  // True if all were removed.
  static bool remove_files(const Folder& folder, const std::set<std::string>& names) noexcept;
  static void remove_lock(const Folder& folder) noexcept;
  std::set<std::string> names() const;
  void register_file(const std::string& name);

  File lock_;  // declared before folder_: acquire() sets both
  Folder folder_;
  std::set<std::string> created_files_;  // names
  bool kept_ = false;
};

}  // namespace svdag
