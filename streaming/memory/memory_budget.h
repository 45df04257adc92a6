// A limit on the sum of large allocations, which bounds the peak memory of a program.
//
// A Reservation is taken before the memory is allocated, and released by its destructor. Small
// objects (lists of paths, JSON, stacks) are not counted: a program needs up to 64 MiB more than
// its budget. Several threads may use one MemoryBudget, but not one Reservation.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>

namespace svdag {

class MemoryBudget {
 public:
  // An owned part of a budget. The budget must outlive it.
  class Reservation {
   public:
    // Of no budget: may only be assigned to.
    Reservation() = default;
    // Adopts `bytes` that are already counted in `budget`.
    Reservation(MemoryBudget* budget, uint64_t bytes) : budget_(budget), bytes_(bytes) {}
    Reservation(Reservation&& other) noexcept
        : budget_(other.budget_), bytes_(std::exchange(other.bytes_, 0)) {}
    Reservation& operator=(Reservation&& other) noexcept;
    ~Reservation() { release(); }

    uint64_t bytes() const { return bytes_; }
    // Grows or shrinks to `bytes`; Error (kMemory) if that exceeds the limit. `purpose`: see
    // reserve().
    void resize(uint64_t bytes, const char* purpose);
    // Like resize(), but returns false, changing nothing, if that exceeds the limit.
    bool try_resize(uint64_t bytes) noexcept;
    // Returns all bytes to the budget.
    void release() noexcept;

   private:
    MemoryBudget* budget_ = nullptr;
    uint64_t bytes_ = 0;
  };

  static constexpr uint64_t kUnlimited = UINT64_MAX;

  // `limit`: in bytes.
  explicit MemoryBudget(uint64_t limit = kUnlimited) : limit_(limit) {}
  MemoryBudget(const MemoryBudget&) = delete;
  MemoryBudget& operator=(const MemoryBudget&) = delete;

  // Reserves `bytes`. If that exceeds the limit, throws Error (kMemory) "the PURPOSE need N MiB in
  // total, ...", N being all bytes in use with these. `purpose`: a plural noun, such as "nodes".
  Reservation reserve(uint64_t bytes, const char* purpose);

  // All in bytes.
  uint64_t limit() const { return limit_; }
  uint64_t used() const { return used_.load(std::memory_order_relaxed); }
  uint64_t peak() const { return peak_.load(std::memory_order_relaxed); }
  // Peak usage since the previous call: the peak of a phase.
  uint64_t lap_peak() { return lap_peak_.exchange(used(), std::memory_order_relaxed); }

 private:
  void take(uint64_t bytes, const char* purpose);
  // False if the limit forbids it. Sets *total to the bytes in use with these.
  bool try_take(uint64_t bytes, uint64_t* total) noexcept;
  void give_back(uint64_t bytes) noexcept { used_.fetch_sub(bytes, std::memory_order_relaxed); }

  uint64_t limit_;
  std::atomic<uint64_t> used_{0};
  std::atomic<uint64_t> peak_{0};
  std::atomic<uint64_t> lap_peak_{0};
};

// The default of --memory in bytes: half of this machine's memory, or of the limit of this
// process's cgroup if that is lower.
uint64_t default_memory_limit();
// Returns `memory` in bytes, or the default if it is 0 (--memory not given).
inline uint64_t memory_or_default(uint64_t memory) {
  return memory != 0 ? memory : default_memory_limit();
}
// Largest resident set of this process so far, in bytes.
uint64_t peak_resident_bytes();
// Processor time of this process so far, user and system, all threads together, in seconds.
double cpu_seconds();

}  // namespace svdag
