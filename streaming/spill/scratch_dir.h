// The private folder in which one bake spills.
//
// OUT.svdag.scratch/ beside the output, or under --scratch DIR. The folder has mode 0700 and is
// owned by the process that holds the flock on its file `owner`; a lock dies with its process, so
// a folder whose owner was killed can be taken over at once, and a live one never. Files in it are
// made with O_EXCL | O_NOFOLLOW, mode 0600: nothing that was planted is followed or written to.
// Rejected: process ids as locks (they are reused), names under /tmp (shared, often in memory).
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "streaming/file/file.h"
#include "streaming/file/file_folder.h"

namespace svdag {

// Another process owns the folder: it may be done later. kUsage, for most people have begun a bake
// twice by mistake.
class ScratchInUse : public Error {
 public:
  explicit ScratchInUse(const std::string& path)
      : Error(ExitCode::kUsage, "another bake is using this scratch folder: wait for it, or end it",
              path) {}
};

class ScratchDir {
 public:
  // The folder for `output`: OUTPUT.scratch, or, if `under` is not empty, a folder in `under` named
  // after the output and a hash of its absolute path, so that many bakes may share `under`. A name
  // that would be too long for a file system is cut, and has the hash, too.
  static std::string path_for(const std::string& output, const std::string& under);

  // Whether a process owns the folder `path` now.
  static bool in_use(const std::string& path);

  // Creates the folder, or takes it over with all it holds. A folder that another process owns is
  // ScratchInUse; one that is not ours to use (a link, another user's, no folder,
  // one with files but without a lock) and one that cannot be made are Errors (kOutput).
  explicit ScratchDir(const std::string& path);
  ScratchDir(const ScratchDir&) = delete;
  ScratchDir& operator=(const ScratchDir&) = delete;
  // Gives the lock back; removes the folder unless keep() was called.
  ~ScratchDir();

  const std::string& path() const { return folder_.path(); }
  bool has(const std::string& name) const { return folder_.has(name); }
  // A new file, open for reading and writing; one of that name that is there is removed first.
  File create(const std::string& name);
  // A file that is there, open for reading and writing.
  File open(const std::string& name) { return folder_.open(name); }
  void remove(const std::string& name);
  // Removes every file but the lock.
  void clear();
  // Makes the names of files durable.
  void sync() const { folder_.sync(); }
  // Makes the name of the folder durable.
  void sync_itself() const { sync_folder(folder_of(path())); }
  // From now on the folder outlives this object: something in it can be resumed.
  void keep(bool kept = true) { kept_ = kept; }

  // Bytes free on its file system for this user.
  uint64_t free_bytes() const { return folder_.free_bytes(); }

 private:
  static Folder own(const std::string& path, File* owner);
  template <class Action>
  static bool attempt(const Action& action) noexcept;
  // Whether all are gone.
  static bool remove_files(const Folder& folder, const std::set<std::string>& names) noexcept;
  static void remove_lock(const Folder& folder) noexcept;
  std::set<std::string> names() const;

  File owner_;  // before folder_: own() sets both
  Folder folder_;
  std::set<std::string> made_;  // names of files
  bool kept_ = false;
};

}  // namespace svdag
