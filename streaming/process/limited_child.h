// Work that reads untrusted bytes with code that is not ours, in a process that can only compute.
//
// run_limited() forks. The child gives up what it could do harm with, in this order: other files
// (every descriptor but one pipe is closed, no new one can be had), memory and time beyond its
// limits (setrlimit), privileges (no_new_privs), and every system call but a dozen that a decoder
// of bytes in memory needs (a seccomp filter: read, write, memory, locks, time, exit). It sends
// what it makes through the pipe, in blocks, and ends. Whatever becomes of it, a crash, a limit, a
// call that is forbidden, is one Error for who asked.
//
// Who asked reads the blocks as those of a hostile program: their sizes are checked here, their
// content by the one who knows what it should be.
//
// Other threads of the parent are no harm: after fork() the child has one thread, glibc keeps its
// allocator usable there, and `work` uses nothing else that they may have locked (it must make its
// own MemoryBudget). Rejected: a program of its own that is executed (a reader in a library cannot
// know where it is installed, nor a test), one long-lived child (the next file would meet what the
// last has left), shared memory for the result (a hostile child could change it after it was
// checked), ptrace (slow), seccomp's strict mode (no memory can be had in it).
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

// Runs work(out) in a limited child and hands its output to `use`. An Error of `work` is thrown
// here, too; a child that does not finish is an Error (kBadInput) "`path`: the decoder was stopped:
// it ...". Error (kUsage) where a filter is asked for and the system has none.
void run_limited(const ChildLimits& limits, const std::string& path,
                 const std::function<void(const BlockSink& out)>& work, const BlockSink& use);

}  // namespace svdag
