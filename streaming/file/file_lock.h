// Tests whether a process holds the lock of a file (File::try_lock).
//
// The test takes a shared lock for a moment: it does not disturb other tests, and a try_lock()
// fails only in that moment. NFS implements flock with byte-range locks, where an exclusive lock
// needs a file opened for writing; the shared one works with a file opened for reading.
#pragma once

#include <string>

namespace svdag {

// Also returns false if the file cannot be opened or its file system has no locks.
bool is_locked(const std::string& path);

}  // namespace svdag
