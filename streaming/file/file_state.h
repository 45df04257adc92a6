// What tells, without reading it, that a file is not what it was.
//
// A write changes the size or the time of the last write, a rename that puts another file in its
// place the inode. The time of the last access is no part of it, for whoever reads sets it; nor is
// that of the last change of the inode, for a hard link, chmod or a backup sets it and changes
// nothing that is read. So a write whose time is set back afterwards, as if to hide it, is not
// seen; and two writes within one tick of the kernel's clock (4 ms) that leave the size as it was
// look like one.
#pragma once

#include <array>
#include <cstdint>

#include "streaming/file/file.h"

namespace svdag {

struct FileState {
  uint64_t device = 0, inode = 0, size = 0;
  std::array<int64_t, 2> written{};  // mtime: seconds, nanoseconds

  bool operator==(const FileState&) const = default;
};

// Of an open file; a client of a file server asks it anew whenever a file is opened (the
// close-to-open rule of NFS).
FileState state_of(const File& file);

// Throws Error (kBadInput) if `file` was cut short or written since it was `before`.
void require_unchanged(const File& file, const FileState& before);

}  // namespace svdag
