// The I/O thread of a spill file, which executes reads and writes in the order of the requests.
//
// So a block is never read before it is written, nor overwritten before its last reader has it.
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

// One read or write of a block. After submit() only the queue may access it until wait() returns.
struct SpillTransfer {
  SpillBlock block;
  uint32_t position = 0;  // in the file, in blocks
  bool writes = false;
  bool done = true;
  std::exception_ptr failure;  // of a read; check() throws a write's
};

class SpillQueue {
 public:
  static constexpr size_t kMaxSpares = 4;

  SpillQueue(File file, size_t block_bytes);
  ~SpillQueue();

  const std::string& path() const { return file_.path(); }
  // Queues a transfer. If this throws (out of memory or threads), it was not queued and counts as
  // done.
  void submit(SpillTransfer* transfer);
  // Marks a transfer that was not queued as done, so that no thread waits for it.
  void cancel(SpillTransfer* transfer) noexcept;
  void wait(SpillTransfer* transfer);
  // Throws the error of the first failed write. Cheap if there is none.
  void check() const;
  // Waits for all requests, then syncs the file to disk.
  void sync();

  // sync(), then File::link_as().
  void link_as(const std::string& path);

  // Writers continue with a spare block while their own is being written. The queue has at most
  // kMaxSpares spares, and at most one per writer.
  void enter_writer();
  void leave_writer();
  // Returns an idle spare, waiting for one if necessary; null if there is none and the budget has
  // no room.
  SpillTransfer* take_spare(MemoryBudget* budget);

  uint64_t written_bytes() const { return written_.load(std::memory_order_relaxed); }
  uint64_t read_bytes() const { return read_.load(std::memory_order_relaxed); }

 private:
  void work();
  void execute(SpillTransfer* transfer);
  // Waits for an idle spare; returns its position in spares_.
  std::vector<std::unique_ptr<SpillTransfer>>::iterator idle_spare(
      std::unique_lock<std::mutex>* lock);

  File file_;
  const size_t block_bytes_;

  mutable std::mutex mutex_;
  std::condition_variable requested_, done_;
  std::deque<SpillTransfer*> queue_;
  uint64_t submitted_ = 0, completed_ = 0;
  size_t writers_ = 0;
  std::vector<std::unique_ptr<SpillTransfer>> spares_;  // idle if done
  bool stop_ = false;
  std::exception_ptr failure_;
  std::atomic<bool> failed_{false};
  std::atomic<uint64_t> written_{0}, read_{0};
  std::jthread thread_;  // started by the first request
};

}  // namespace svdag
