// Identity and modification time of a file, to detect a change without reading the content.
//
// A write changes the size or the modification time; a rename that replaces the file changes the
// inode. The access time is left out because reading sets it, the inode change time because links,
// chmod and backups set it. Not detected: a write whose modification time is set back afterwards,
// and a second write of the same size within one tick of the kernel's clock (4 ms).
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "streaming/file/file.h"

namespace svdag {

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

}  // namespace svdag
