// Whether somebody holds the lock of a file (File::try_lock), asked without taking it.
//
// Asked by a shared lock, which keeps out nobody else who asks, and an owner only for the moment
// of the question. NFS makes byte-range locks of flock: there a lock that excludes needs a file
// that is open for writing, a shared one needs what we have, one that is open for reading.
#pragma once

#include <string>

namespace svdag {

// False as well if there is no such file, or no locks where it is.
bool is_locked(const std::string& path);

}  // namespace svdag
