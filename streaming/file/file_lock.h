// Tests whether a file is locked (File::try_lock), without locking it.
//
// The test takes a shared lock for a moment: it excludes no other test, and an owner only for that
// moment. NFS implements flock with byte-range locks, where an exclusive lock needs a file open for
// writing and a shared one a file open for reading, which is what we have.
#pragma once

#include <string>

namespace svdag {

// Returns false also if the file does not exist or its file system has no locks.
bool is_locked(const std::string& path);

}  // namespace svdag
