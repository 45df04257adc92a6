// The I/O thread of a spill file: executes reads and writes in the order of the requests. So a
// block is never read before it was written, and never overwritten before its last reader has it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "streaming/file/file.h"
#include "streaming/spill/spill_block.h"

namespace svdag {

// One read or write. The requester must not touch it until it is done.
struct SpillTransfer {
  SpillBlock block;
  uint32_t place = 0;  // in the file, in blocks
  bool writes = false;
  bool done = true;
  std::exception_ptr failure;  // of a read; a write that fails is the failure of the file
};

class SpillQueue {
 public:
  static constexpr size_t kSpares = 4;

  SpillQueue(File file, size_t block_bytes);
  ~SpillQueue();

  const std::string& path() const { return file_.path(); }
  // If it throws (no memory, no thread), nothing was queued and the transfer counts as done.
  void submit(SpillTransfer* transfer);
  // Marks a transfer done that was never queued, so that no thread waits for it.
  void take_back(SpillTransfer* transfer) noexcept;
  void wait(SpillTransfer* transfer);
  // Throws what the first write that failed threw. Cheap if none has.
  void check() const;
  // Waits for all requests, and syncs the file to disk.
  void sync();

  // The same, then File::link_as().
  void link_as(const std::string& path);

  // A writer continues with a spare block while its own is being written: at most kSpares, and at
  // most one per writer.
  void enter_writer();
  void leave_writer();
  // A spare that is idle, waiting for it if need be; null if the budget has room for none.
  SpillTransfer* take_spare(MemoryBudget* budget);

  uint64_t written_bytes() const { return written_.load(std::memory_order_relaxed); }
  uint64_t read_bytes() const { return read_.load(std::memory_order_relaxed); }

 private:
  void work();
  void carry_out(SpillTransfer* transfer);
  // Waits for a spare to be idle; its place in spares_.
  std::vector<std::unique_ptr<SpillTransfer>>::iterator idle_spare(
      std::unique_lock<std::mutex>* lock);

  File file_;
  const size_t block_bytes_;

  mutable std::mutex mutex_;
  std::condition_variable asked_, done_;
  std::deque<SpillTransfer*> queue_;
  uint64_t submitted_ = 0, completed_ = 0;
  size_t writers_ = 0;
  std::vector<std::unique_ptr<SpillTransfer>> spares_;  // done: idle
  bool stop_ = false;
  std::exception_ptr failure_;
  std::atomic<bool> failed_{false};
  std::atomic<uint64_t> written_{0}, read_{0};
  std::jthread thread_;  // started by the first transfer
};

}  // namespace svdag
