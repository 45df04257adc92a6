// Runs third-party code on untrusted bytes, in a child process that can only compute.
//
// run_limited() forks. The child limits its memory and processor time (setrlimit), closes all
// descriptors but one pipe and cannot open any, gives up privileges (no_new_privs), and forbids
// itself all system calls but the few that a decoder of bytes in memory needs (a seccomp filter:
// read, write, memory, locks, time, exit). It sends its result through the pipe, in blocks, and
// exits. A crash, an exceeded limit or a forbidden call is one Error for the caller.
//
// The blocks are input from a possibly hostile program: run_limited() checks their sizes, the
// caller must check their content.
//
// The parent may have other threads: after fork() the child has one thread, glibc keeps its
// allocator usable, and `work` must not use anything else that they may have locked (it creates its
// own MemoryBudget).
// Rejected: a separate executable (neither a reader in a library nor a test knows where it is
// installed), one long-lived child (a file could affect the next one), shared memory for the result
// (a hostile child could change it after the check), ptrace (slow), seccomp's strict mode (memory
// cannot be allocated).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace svdag {

struct ChildLimits {
  uint64_t memory = 0;   // bytes of address space beyond those that the child inherits
  uint64_t seconds = 0;  // of processor time; the parent waits ten times as long for each read
  bool filter = true;    // false: all system calls are allowed; the limits still apply
};

using BlockSink = std::function<void(std::span<const std::byte>)>;

// Maximum size of a block in bytes; longer output is split into such blocks. A multiple of the
// sizes of points and triangles.
constexpr size_t kChildBlock = size_t(72) * 8192;

// Runs work(out) in a limited child and passes the blocks of its output to `use`, in order. An
// Error of `work` is rethrown with its message, and with its code if that is kMemory or kUsage,
// else as kBadInput. If the child does not finish: Error (kBadInput) "PATH: the decoder was
// stopped: it ...". Error (kUsage) if a filter is requested and the system has none; Error
// (kMemory) if no process can be started. If `use` throws, the child is killed.
void run_limited(const ChildLimits& limits, const std::string& path,
                 const std::function<void(const BlockSink& out)>& work, const BlockSink& use);

}  // namespace svdag
