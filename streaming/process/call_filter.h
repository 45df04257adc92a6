// A filter of system calls for a child that only computes (streaming/process/limited_child.h).
#pragma once

namespace svdag {

// Allows this process only the system calls of a computation; any other one ends it with SIGSYS
// (or fails, where the C library computes with it).
// This cannot be undone. Returns false if the system has no seccomp filters, or the processor is
// neither x86-64 nor aarch64.
bool install_call_filter();

}  // namespace svdag
