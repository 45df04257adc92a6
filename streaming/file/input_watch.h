// Detects changes of a program's input files while it reads them.
//
// Other programs may write to a file at any time. If an input changed, its content was mixed, and
// results and errors are meaningless: the change is then reported instead. Rejected: copies, locks
// (other programs ignore them), hashing before and after (one more read of each file).
#pragma once

#include <array>
#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include "streaming/file/file.h"

namespace svdag {

// Identity and modification time of a file, to detect a change without reading the content.
//
// A write changes the size or the modification time; a rename that replaces the file changes the
// inode. The access time is left out because reading sets it, the inode change time because links,
// chmod and backups set it. Not detected: a write whose modification time is set back afterwards,
// and a second write of the same size within one tick of the kernel's clock (4 ms).
struct FileState {
  uint64_t device = 0, inode = 0, size = 0;
  std::array<int64_t, 2> written{};  // mtime: seconds, nanoseconds

  bool operator==(const FileState&) const = default;
};

// Returns the state of an open file; Error (kBadInput) if it cannot be read. NFS clients fetch it
// from the server whenever a file is opened (close-to-open consistency).
FileState state_of(const File& file);

// The same for a descriptor; `path` is for errors.
FileState state_of(int descriptor, const std::string& path);

// The message about an input file that changed.
constexpr const char* kChangedInput = "was changed while it was read";

class InputWatch {
 public:
  // Records a file that is read through this descriptor, before it is read. It must stay open.
  void add(const File& file) { files_.push_back({file.path(), file.descriptor(), state_of(file)}); }
  // Records a file that is opened again by its path: another file of that name is a change, too.
  void add_reopened(const File& file) { files_.push_back({file.path(), kReopen, state_of(file)}); }
  bool empty() const { return files_.empty(); }

  // Error (kBadInput) that names the first changed file.
  void check() const;
  // Returns work(). If a file has changed by then, that is the Error, whatever work() throws.
  template <class Work>
  auto guard(const Work& work) const {
    try {
      auto result = work();
      check();
      return result;
    } catch (const std::exception&) {
      check();
      throw;
    }
  }

 private:
  static constexpr int kReopen = -1;
  struct WatchedFile {
    std::string path;
    int descriptor;  // or kReopen
    FileState state;
  };

  std::vector<WatchedFile> files_;
};

}  // namespace svdag
