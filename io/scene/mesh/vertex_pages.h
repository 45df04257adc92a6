// Vertex positions that do not fit in memory, looked up one by one: pages in a spill file, of which
// the last ones that were used are in memory.
//
// The faces of most files refer to vertices in about the order of the file, so that each page is
// read once. Where they do not, lookups soon cost more than a join
// (io/scene/mesh/vertex_windows.h), and is_costly() says so.
// A page is a block of the file. Pages leave memory in the order in which they came (the rows of a
// scan need a few at a time, a random order is for the join); after two consecutive pages the next
// one is read ahead.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "io/scene/mesh/vertex_windows.h"

namespace svdag {

class VertexPages {
 public:
  // Positions are three floats each, or (`single` is false) three doubles.
  VertexPages(const SpillSpace& space, MemoryBudget* budget, bool single);

  uint64_t size() const { return size_; }
  // Appends whole positions.
  void add(std::span<const std::byte> positions);
  // `i` < size().
  Point operator[](uint64_t i) {
    const uint64_t page = uint64_t(__uint128_t(i) * reciprocal_ >> 64);
    ++lookups_;
    const std::byte* bytes = page < loaded_.size() ? loaded_[page] : last_.bytes().data();
    if (bytes == nullptr) bytes = load(page);
    return point_at(bytes + (i - page * page_size_) * position_bytes_);
  }
  // True if a join would have been cheaper than the lookups so far. It writes and reads a reference
  // and a position for each: half of that is allowed, and a quarter of the pages.
  bool is_costly() const {
    const uint64_t allowed = pages_.size() / 4;
    return reads_ > allowed && (reads_ - allowed) * page_size_ > lookups_;
  }
  // Calls use(i, position) for all vertices, in order.
  template <class Use>
  void visit(const Use& use) {
    uint64_t i = 0;
    for_each_page(true, [&](std::span<const std::byte> bytes) {
      for (; bytes.size() >= position_bytes_; bytes = bytes.subspan(position_bytes_))
        use(i++, point_at(bytes.data()));
    });
  }
  // Adds all vertices to `windows`, and frees them here unless `keep`.
  void copy_to(VertexWindows* windows, bool keep);

 private:
  struct Frame {
    uint64_t page;
    SpillBlock block;
  };

  Point point_at(const std::byte* p) const {
    return single_ ? load_point<float>(p) : load_point<double>(p);
  }
  template <class Use>
  void for_each_page(bool keep, const Use& use) {
    unload();
    for (OwnedStream& page : pages_) {
      {
        SpillReader reader = page.read(budget_);
        use(reader.next());
      }
      if (!keep) page = OwnedStream();
    }
    use(last_.bytes().first(last_filled_));
  }
  const std::byte* load(uint64_t page);
  void request(uint64_t page);
  SpillBlock free_block();
  void unload();
  void write_page();

  SpillFile* file_;
  const std::function<uint64_t()>& new_number_;
  MemoryBudget* budget_;
  bool single_;
  size_t position_bytes_;
  uint64_t page_size_;   // vertices
  uint64_t reciprocal_;  // of page_size_, times 2^64, rounded up: exact below 2^64 / page_size_
  size_t max_frames_;
  uint64_t size_ = 0;
  std::vector<OwnedStream> pages_;        // full ones
  std::vector<const std::byte*> loaded_;  // of each: its bytes if they are in memory, or null
  SpillBlock last_;                       // the page that is being filled
  size_t last_filled_ = 0;                // bytes
  std::optional<SpillWriter> being_written_;
  std::deque<Frame> frames_;         // the pages in memory, the oldest first
  std::optional<SpillFetch> fetch_;  // of page requested_
  uint64_t requested_ = 0;
  uint64_t last_read_ = 0;  // page
  uint64_t reads_ = 0, lookups_ = 0;
};

}  // namespace svdag
