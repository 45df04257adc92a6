// Counts every large reservation against one limit, so that a bake can promise its peak.
//
// A Reservation is taken before the memory is allocated and given back when it dies. Small objects
// (lists of paths, JSON, stacks) are not counted; the 64 MiB beside --memory are for them.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>

namespace svdag {

class MemoryBudget {
 public:
  class Reservation {
   public:
    Reservation() = default;
    Reservation(MemoryBudget* budget, uint64_t bytes) : budget_(budget), bytes_(bytes) {}
    Reservation(Reservation&& other) noexcept
        : budget_(other.budget_), bytes_(std::exchange(other.bytes_, 0)) {}
    Reservation& operator=(Reservation&& other) noexcept;
    ~Reservation() { release(); }

    uint64_t bytes() const { return bytes_; }
    // Grows (or shrinks) to `bytes`; growing beyond the limit is an Error (kMemory).
    void resize(uint64_t bytes, const char* purpose);
    // The same, but beyond the limit false, and nothing changes.
    bool try_resize(uint64_t bytes) noexcept;
    void release() noexcept;

   private:
    MemoryBudget* budget_ = nullptr;
    uint64_t bytes_ = 0;
  };

  static constexpr uint64_t kUnlimited = UINT64_MAX;

  explicit MemoryBudget(uint64_t limit = kUnlimited) : limit_(limit) {}
  MemoryBudget(const MemoryBudget&) = delete;
  MemoryBudget& operator=(const MemoryBudget&) = delete;

  // Throws Error (kMemory) naming `purpose` and the --memory that would do, if the limit is passed.
  Reservation reserve(uint64_t bytes, const char* purpose);

  uint64_t limit() const { return limit_; }
  uint64_t used() const { return used_.load(std::memory_order_relaxed); }
  uint64_t peak() const { return peak_.load(std::memory_order_relaxed); }
  // Peak usage since the previous call, in bytes.
  uint64_t lap_peak() { return lap_peak_.exchange(used(), std::memory_order_relaxed); }

 private:
  void take(uint64_t bytes, const char* purpose);
  // Whether the limit allows it; *wanted: what would be in use.
  bool try_take(uint64_t bytes, uint64_t* wanted) noexcept;
  void give_back(uint64_t bytes) noexcept { used_.fetch_sub(bytes, std::memory_order_relaxed); }

  uint64_t limit_;
  std::atomic<uint64_t> used_{0};
  std::atomic<uint64_t> peak_{0};
  std::atomic<uint64_t> lap_peak_{0};
};

// Half of what this machine, or the cgroup we run in, allows: the default of --memory.
uint64_t default_memory_limit();
// What --memory says; 0: nothing, so the default.
inline uint64_t memory_or_default(uint64_t memory) {
  return memory != 0 ? memory : default_memory_limit();
}
// Largest resident set of this process so far, in bytes.
uint64_t peak_resident_bytes();
// Processor time of the process so far, of all its threads.
double cpu_seconds();

}  // namespace svdag
