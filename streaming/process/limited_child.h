// Work that reads untrusted bytes with code that is not ours, in a process that can only compute.
//
// run_limited() forks. The child gives up its rights in this order: other files (all descriptors
// but one pipe are closed, and none can be opened), memory and time beyond its limits (setrlimit),
// privileges (no_new_privs), and all system calls but the dozen that a decoder of bytes in memory
// needs (a seccomp filter: read, write, memory, locks, time, exit). It sends its result through the
// pipe, in blocks, and exits. A crash, an exceeded limit or a forbidden call is one Error for the
// caller.
//
// The caller treats the blocks as input from a hostile program: their sizes are checked here, their
// content by the caller.
//
// Other threads of the parent do no harm: after fork() the child has one thread, glibc keeps its
// allocator usable, and `work` uses nothing else that they may have locked (it must create its own
// MemoryBudget). Rejected: a separate executable (neither a reader in a library nor a test knows
// where it is installed), one long-lived child (a file could affect the next one), shared memory
// for the result (a hostile child could change it after the check), ptrace (slow), seccomp's strict
// mode (memory cannot be allocated).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace svdag {

struct ChildLimits {
  uint64_t memory = 0;   // bytes that the child may have beyond what it inherits, used or free
  uint64_t seconds = 0;  // of processor time; it may keep us waiting ten times as long
  bool filter = true;  // false: any system call may be made; only crashes and floods are contained
};

using BlockSink = std::function<void(std::span<const std::byte>)>;

// Bytes of a block at most; longer output is cut into blocks of so many. A multiple of the sizes of
// points and triangles.
constexpr size_t kChildBlock = size_t(72) * 8192;

// Runs work(out) in a limited child and passes its output to `use`. Rethrows an Error of `work`; a
// child that does not finish is an Error (kBadInput) "`path`: the decoder was stopped: it ...".
// Error (kUsage) if a filter is requested and the system has none.
void run_limited(const ChildLimits& limits, const std::string& path,
                 const std::function<void(const BlockSink& out)>& work, const BlockSink& use);

}  // namespace svdag
