// Detects changes of a program's input files while it reads them.
//
// Other programs may write to a file at any time. If an input changed, its content was mixed, and
// results and errors are meaningless: the change is then reported instead. Rejected: copies, locks
// (other programs ignore them), hashing before and after (one more read of each file).
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "streaming/file/file_state.h"

namespace svdag {

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
