#include "builder/run/run_check.h"

#include <algorithm>
#include <type_traits>

#include "io/brick.h"
#include "io/dag/write/node_key.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// Reads the payload of a run in chunks and hashes the checksums of its blocks.
class Payload {
 public:
  Payload(const RunFile& run, MemoryBudget* budget)
      : reader_(run.file(), run.header(), {0, run.layout().payload}, budget) {}

  uint64_t position() const { return position_; }
  // The next chunk, of at most `max_bytes`. Must not be called at the end.
  std::span<const std::byte> take(uint64_t max_bytes) {
    if (rest_.empty()) {
      rest_ = reader_.next();
      const uint64_t checksum = reader_.checksum();
      hasher_.update(std::as_bytes(std::span(&checksum, 1)));
      check_interrupt();
    }
    const auto chunk = rest_.first(std::min<uint64_t>(max_bytes, rest_.size()));
    rest_ = rest_.subspan(chunk.size());
    position_ += chunk.size();
    return chunk;
  }
  Hasher128* hasher() { return &hasher_; }

 private:
  RunReader reader_;
  std::span<const std::byte> rest_;
  uint64_t position_ = 0;
  Hasher128 hasher_;
};

// The offset in the file of byte `position` of the payload.
uint64_t offset_of(uint64_t position) {
  return sizeof(RunHeader) + position / kRunPayload * kRunBlockBytes + kSpillHeader +
         position % kRunPayload;
}

// Marks the keys of a level that are reached, for a window of ranks.
class RankMarks {
 public:
  static constexpr const char* kPurpose = "the check of a run";

  RankMarks(uint64_t bytes, MemoryBudget* budget)
      : max_ranks_(8 * std::max<uint64_t>(bytes, 1)), counted_(budget->reserve(0, kPurpose)) {}

  uint64_t end() const { return first_ + size_; }
  // Begins an unmarked window at rank `first` of `count`.
  void begin(uint64_t first, uint64_t count) {
    first_ = first;
    marked_ = {};
    const uint64_t size = std::min(max_ranks_, count - first);
    counted_.resize((size + 7) / 8, kPurpose);
    size_ = size;
    marked_.resize((size + 63) / 64);
    if (size % 64 != 0) marked_.back() = ~uint64_t(0) << size % 64;
  }
  void mark(uint64_t rank) {
    const uint64_t i = rank - first_;
    if (i < size_) marked_[i / 64] |= uint64_t(1) << i % 64;
  }
  bool all() const {
    return std::all_of(marked_.begin(), marked_.end(),
                       [](uint64_t marks) { return marks == ~uint64_t(0); });
  }

 private:
  uint64_t max_ranks_;  // ranks in a window
  uint64_t first_ = 0, size_ = 0;
  MemoryBudget::Reservation counted_;
  std::vector<uint64_t> marked_;  // a bit per rank of the window; those past its end are set
};

class Check {
 public:
  Check(const RunFile& run, uint64_t bitmap_bytes, MemoryBudget* budget)
      : run_(run), budget_(budget), payload_(run, budget), marks_(bitmap_bytes, budget) {}

  void run() {
    const int brick_level = int(run_.header().levels) - 2;
    scan<Brick>(brick_level);
    for (int level = brick_level - 1; level >= 0; --level) {
      begin_marks(level + 1, 0);
      scan<NodeKey>(level);
      require_reached(level + 1);
    }
    begin_marks(0, 0);
    require(marks_.all(), kNotReached, offset_of(payload_.position()));
    skip_zeros(run_.layout().roots.begin);
    skip_checked(run_.layout().roots.end);
    skip_zeros(run_.layout().ranges.begin);
    skip_checked(run_.layout().ranges.end);
    skip_zeros(run_.layout().layers.begin);
    skip_checked(run_.layout().payload);
    const RunHeader& header = run_.header();
    require(content_hash_of(header, payload_.hasher()) ==
                Hash128{header.content_hash[0], header.content_hash[1]},
            "the blocks do not match the content hash", offsetof(RunHeader, content_hash));
  }

 private:
  static constexpr const char* kNotReached = "a node is not reached from any root";

  void require(bool condition, const char* sentence, uint64_t offset) const {
    require_run(condition, run_.file(), sentence, offset);
  }
  // Reports the offset of the chunk read last.
  void require_here(bool condition, const char* sentence) const {
    if (!condition) [[unlikely]]
      require(false, sentence, offset_of(chunk_begin_));
  }
  std::span<const std::byte> take_to(uint64_t position) {
    chunk_begin_ = payload_.position();
    return payload_.take(position - chunk_begin_);
  }

  // Checks that all bytes up to `position` are zero.
  void skip_zeros(uint64_t position) {
    while (payload_.position() < position) {
      for (const std::byte byte : take_to(position))
        require_here(byte == std::byte(0), "the gap between two sections is not zero");
    }
  }
  // Skips bytes whose content RunFile::open() checks; their checksums are still verified.
  void skip_checked(uint64_t position) {
    while (payload_.position() < position) take_to(position);
  }

  template <class Key>
  void scan(int level) {
    const RunSection& section = run_.layout().levels[level];
    const uint64_t below = std::is_same_v<Key, NodeKey> ? run_.key_count(level + 1) : 0;
    skip_zeros(section.begin);
    Key last{};  // below every key, since no key is zero
    while (payload_.position() < section.end) {
      const auto chunk = take_to(section.end);
      for (const Key& key :
           std::span(reinterpret_cast<const Key*>(chunk.data()), chunk.size() / sizeof(Key))) {
        require_here(last < key, "nodes are empty or do not ascend");
        last = key;
        if constexpr (std::is_same_v<Key, NodeKey>) check_children(below, key);
      }
    }
  }

  // `count`: number of keys of the level below.
  void check_children(uint64_t count, const NodeKey& key) {
    for (const uint32_t child : key) {
      require_here(child <= count, "a child is outside of the run");
      if (child != 0) marks_.mark(child - 1);
    }
  }

  void begin_marks(int level, uint64_t first) {
    marks_.begin(first, run_.key_count(level));
    for (const SubDagRoot& root : run_.roots()) {
      if (root.level == level) marks_.mark(root.rank);
    }
  }

  // The scan of the level above has marked the first window of `level`. For each further window the
  // level above is read again.
  void require_reached(int level) {
    for (;;) {
      require(marks_.all(), kNotReached, offset_of(run_.layout().levels[level].begin));
      if (marks_.end() == run_.key_count(level)) return;
      begin_marks(level, marks_.end());
      const std::unique_ptr<BlockSource> above = run_.read(level - 1, budget_);
      for (auto block = above->next(); !block.empty(); block = above->next()) {
        check_interrupt();
        for (const NodeKey& key : std::span(reinterpret_cast<const NodeKey*>(block.data()),
                                            block.size() / sizeof(NodeKey)))
          check_children(run_.key_count(level), key);
      }
    }
  }

  const RunFile& run_;
  MemoryBudget* budget_;
  Payload payload_;
  uint64_t chunk_begin_ = 0;  // position in the payload of the chunk read last
  RankMarks marks_;           // of the level below the scanned one
};

}  // namespace

void check_run(const RunFile& run, uint64_t bitmap_bytes, MemoryBudget* budget) {
  Check(run, bitmap_bytes, budget).run();
}

}  // namespace svdag
