#include "streaming/spill/spill_queue.h"

#include <algorithm>
#include <utility>

#include "streaming/error.h"

namespace svdag {

SpillQueue::SpillQueue(File file, size_t block_bytes)
    : file_(std::move(file)), block_bytes_(block_bytes) {
  file_.use_direct();  // if unsupported, the page cache is used
}

SpillQueue::~SpillQueue() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  requested_.notify_one();
}

void SpillQueue::submit(SpillTransfer* transfer) {
  try {
    const std::lock_guard lock(mutex_);
    if (!thread_.joinable()) thread_ = std::jthread([this] { work(); });
    queue_.push_back(transfer);
    transfer->done = false;
    transfer->failure = nullptr;
    ++submitted_;
  } catch (...) {
    cancel(transfer);
    throw;
  }
  requested_.notify_one();
}

void SpillQueue::cancel(SpillTransfer* transfer) noexcept {
  const std::lock_guard lock(mutex_);
  transfer->done = true;
  done_.notify_all();
}

void SpillQueue::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    requested_.wait(lock, [&] { return stop_ || !queue_.empty(); });
    if (queue_.empty()) return;
    SpillTransfer* const next = queue_.front();
    queue_.pop_front();
    lock.unlock();
    execute(next);
    lock.lock();
    if (next->writes && next->failure && !failure_) {
      failure_ = next->failure;
      failed_.store(true, std::memory_order_release);
    }
    next->done = true;
    ++completed_;
    done_.notify_all();
  }
}

void SpillQueue::execute(SpillTransfer* transfer) {
  const std::span<std::byte> bytes = transfer->block.bytes();
  const uint64_t offset = uint64_t(transfer->position) * block_bytes_;
  try {
    if (transfer->writes) {
      if (failed_.load(std::memory_order_relaxed)) return;  // no further writes after a failure
      file_.write_at(offset, bytes);
      written_.fetch_add(bytes.size(), std::memory_order_relaxed);
    } else {
      const size_t n = file_.read_some_at(offset, bytes);
      std::fill(bytes.begin() + ptrdiff_t(n), bytes.end(), std::byte(0));  // detected as damage
      read_.fetch_add(n, std::memory_order_relaxed);
    }
  } catch (...) {
    transfer->failure = std::current_exception();
  }
}

void SpillQueue::wait(SpillTransfer* transfer) {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return transfer->done; });
}

void SpillQueue::check() const {
  if (!failed_.load(std::memory_order_acquire)) return;
  const std::lock_guard lock(mutex_);
  std::rethrow_exception(failure_);
}

void SpillQueue::sync() {
  {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [&, until = submitted_] { return completed_ >= until; });
  }
  check();
  try {
    file_.sync();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    failed_.store(true, std::memory_order_release);
    throw;
  }
}

void SpillQueue::link_as(const std::string& path) {
  sync();
  file_.link_as(path);
}

void SpillQueue::enter_writer() {
  const std::lock_guard lock(mutex_);
  ++writers_;
}

void SpillQueue::leave_writer() {
  std::unique_lock lock(mutex_);
  --writers_;
  // Checked after each wait: other writers may leave meanwhile, and the remaining ones need spares.
  while (spares_.size() > std::min(kMaxSpares, writers_)) {
    const auto idle = std::ranges::find_if(spares_, [](const auto& spare) { return spare->done; });
    if (idle != spares_.end()) {
      spares_.erase(idle);
    } else {
      done_.wait(lock);
    }
  }
}

SpillTransfer* SpillQueue::take_spare(MemoryBudget* budget) {
  std::unique_lock lock(mutex_);
  const auto idle = [](const std::unique_ptr<SpillTransfer>& spare) { return spare->done; };
  if (spares_.size() < std::min(kMaxSpares, writers_) && std::ranges::none_of(spares_, idle)) {
    try {
      auto spare = std::make_unique<SpillTransfer>();
      spare->block = SpillBlock(budget, block_bytes_);
      spares_.push_back(std::move(spare));
    } catch (const Error&) {
      if (spares_.empty()) return nullptr;
    }
  }
  SpillTransfer* const spare = idle_spare(&lock)->get();
  spare->done = false;
  return spare;
}

std::vector<std::unique_ptr<SpillTransfer>>::iterator SpillQueue::idle_spare(
    std::unique_lock<std::mutex>* lock) {
  auto found = spares_.end();
  done_.wait(*lock, [&] {
    found = std::ranges::find_if(spares_,
                                 [](const std::unique_ptr<SpillTransfer>& s) { return s->done; });
    return found != spares_.end();
  });
  return found;
}

}  // namespace svdag
