// The system calls that are left to a child that only computes (streaming/process/limited_child.h).
#pragma once

namespace svdag {

// From now on every other call ends this process with SIGSYS, for good. False where the system has
// no seccomp filters, or no list of ours for its processor.
bool forbid_calls();

}  // namespace svdag
