#include "streaming/memory/memory_budget.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

#include "streaming/error.h"
#include "streaming/memory/cgroup.h"

namespace svdag {

void MemoryBudget::take(uint64_t bytes, const char* purpose) {
  uint64_t total;
  if (try_take(bytes, &total)) return;
  throw Error(ExitCode::kMemory, "the " + std::string(purpose) + " need " +
                                     std::to_string((total >> 20) + 1) +
                                     " MiB in total, but the memory budget is " +
                                     std::to_string(limit_ >> 20) + " MiB: raise --memory");
}

bool MemoryBudget::try_take(uint64_t bytes, uint64_t* total) noexcept {
  // A rejected request is never counted, even for a moment: another thread's request could fail.
  uint64_t before = used_.load(std::memory_order_relaxed), now;
  do {
    now = *total = before + bytes;
    if (now > limit_ || now < before) return false;
  } while (!used_.compare_exchange_weak(before, now, std::memory_order_relaxed));
  for (std::atomic<uint64_t>* highest : {&peak_, &lap_peak_}) {
    uint64_t peak = highest->load(std::memory_order_relaxed);
    while (peak < now && !highest->compare_exchange_weak(peak, now, std::memory_order_relaxed)) {
    }
  }
  return true;
}

MemoryBudget::Reservation MemoryBudget::reserve(uint64_t bytes, const char* purpose) {
  take(bytes, purpose);
  return Reservation(this, bytes);
}

MemoryBudget::Reservation& MemoryBudget::Reservation::operator=(Reservation&& other) noexcept {
  if (this != &other) {
    release();
    budget_ = other.budget_;
    bytes_ = std::exchange(other.bytes_, 0);
  }
  return *this;
}

void MemoryBudget::Reservation::resize(uint64_t bytes, const char* purpose) {
  SVDAG_ASSERT(budget_ != nullptr);
  if (bytes > bytes_) budget_->take(bytes - bytes_, purpose);
  if (bytes < bytes_) budget_->give_back(bytes_ - bytes);
  bytes_ = bytes;
}

bool MemoryBudget::Reservation::try_resize(uint64_t bytes) noexcept {
  SVDAG_ASSERT(budget_ != nullptr);
  uint64_t total;
  if (bytes > bytes_ && !budget_->try_take(bytes - bytes_, &total)) return false;
  if (bytes < bytes_) budget_->give_back(bytes_ - bytes);
  bytes_ = bytes;
  return true;
}

void MemoryBudget::Reservation::release() noexcept {
  if (budget_ != nullptr) budget_->give_back(bytes_);
  bytes_ = 0;
}

uint64_t default_memory_limit() {
  const uint64_t machine = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE));
  return std::min(machine, cgroup_memory_limit()) / 2;
}

uint64_t peak_resident_bytes() {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return uint64_t(usage.ru_maxrss) * 1024;
}

double cpu_seconds() {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace svdag
