// What tells, without reading it, that a file is not what it was.
//
// A write changes the size or the times, a rename that puts another file in its place the inode.
// The time of the last access is no part of it: whoever reads sets it. Two writes within one tick
// of the kernel's clock (4 ms) that leave the size as it was look like one.
#pragma once

#include <array>
#include <cstdint>

#include "streaming/file.h"

namespace svdag {

struct FileState {
  uint64_t device = 0, inode = 0, size = 0;
  std::array<int64_t, 2> written{}, changed{};  // mtime and ctime: seconds, nanoseconds

  bool operator==(const FileState&) const = default;
};

// Of an open file; a client of a file server asks it anew whenever a file is opened (the
// close-to-open rule of NFS).
FileState state_of(const File& file);

}  // namespace svdag
