// An array of fixed size, zeroed: in memory while no more than half of the budget is used, so that
// sorts and bitmaps find the rest; else in an anonymous file that is mapped, so that the system
// keeps in memory what is used. Access in order stays fast, random access then waits for the disk.
// The blocks of the file are allocated before it is mapped. T must be trivial.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "streaming/file/file.h"
#include "streaming/memory/huge_pages.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

// Where a conversion of a whole file keeps its arrays.
struct WorkRoom {
  MemoryBudget* budget = nullptr;
  std::string folder;  // for anonymous files
};

// A room in the folder for temporary files (TMPDIR). Error (kOutput) if there is none.
WorkRoom temporary_room(MemoryBudget* budget);

// The bytes of a WorkArray.
class WorkMemory {
 public:
  WorkMemory() = default;
  // Errors: kMemory, kOutput.
  WorkMemory(uint64_t bytes, const WorkRoom& room);
  WorkMemory(WorkMemory&& other) noexcept { *this = std::move(other); }
  WorkMemory& operator=(WorkMemory&& other) noexcept;
  ~WorkMemory();

  void* data() const { return mapped_ != nullptr ? mapped_ : pages_.data(); }

 private:
  MemoryBudget::Reservation counted_;
  HugePages pages_;
  void* mapped_ = nullptr;
  uint64_t mapped_bytes_ = 0;
};

template <class T>
class WorkArray {
 public:
  WorkArray() = default;
  WorkArray(uint64_t size, const WorkRoom& room) : memory_(size * sizeof(T), room), size_(size) {}

  uint64_t size() const { return size_; }
  T& operator[](uint64_t i) { return static_cast<T*>(memory_.data())[i]; }
  const T& operator[](uint64_t i) const { return static_cast<const T*>(memory_.data())[i]; }
  std::span<const T> elements() const {
    return {static_cast<const T*>(memory_.data()), size_t(size_)};
  }

 private:
  WorkMemory memory_;
  uint64_t size_ = 0;
};

}  // namespace svdag
