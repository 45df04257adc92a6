#include "builder/run_check.h"

#include <algorithm>
#include <optional>

#include "io/brick.h"
#include "streaming/interrupt.h"

namespace svdag {
namespace {

// The payload, piece by piece.
class Payload {
 public:
  Payload(const RunFile& run, MemoryBudget* budget)
      : reader_(run.file(), run.header(), {0, run.layout().payload}, budget) {}

  uint64_t position() const { return position_; }
  // What comes next, `most` bytes at most; not at the end.
  std::span<const std::byte> take(uint64_t most) {
    if (rest_.empty()) {
      rest_ = reader_.next();
      const uint64_t checksum = reader_.checksum();
      hasher_.update(std::as_bytes(std::span(&checksum, 1)));
      check_interrupt();
    }
    const auto piece = rest_.first(std::min<uint64_t>(most, rest_.size()));
    rest_ = rest_.subspan(piece.size());
    position_ += piece.size();
    return piece;
  }
  Hasher128* hasher() { return &hasher_; }

 private:
  RunReader reader_;
  std::span<const std::byte> rest_;
  uint64_t position_ = 0;
  Hasher128 hasher_;
};

// Where byte `position` of the payload stands in the file.
uint64_t offset_of(uint64_t position) {
  return sizeof(RunHeader) + position / kRunPayload * kRunBlockBytes + kSpillHeader +
         position % kRunPayload;
}

class Check {
 public:
  Check(const RunFile& run, MemoryBudget* budget)
      : run_(run),
        payload_(run, budget),
        marked_(budget->reserve(0, kPurpose)) {}

  void run() {
    const int brick_level = int(run_.header().levels) - 2;
    scan<Brick>(brick_level);
    for (int level = brick_level - 1; level >= 0; --level) {
      mark_roots(level + 1);
      scan<NodeKey>(level);
      require_all_marked(level + 1);
    }
    mark_roots(0);
    require_all_marked(0);
    skip_to(run_.layout().roots.begin);
    pass(run_.layout().roots.end);
    skip_to(run_.layout().ranges.begin);
    pass(run_.layout().payload);
    const RunHeader& header = run_.header();
    require(content_hash_of(header, payload_.hasher()) ==
                Hash128{header.content_hash[0], header.content_hash[1]},
            "the blocks do not match the content hash", offsetof(RunHeader, content_hash));
  }

 private:
  static constexpr const char* kPurpose = "the check of a run";

  void require(bool condition, const char* sentence, uint64_t offset) const {
    svdag::require(condition, run_.file(), sentence, offset);
  }
  void require_here(bool condition, const char* sentence) const {
    require(condition, sentence, offset_of(payload_.position()));
  }

  // Zeros up to `position`.
  void skip_to(uint64_t position) {
    while (payload_.position() < position) {
      for (const std::byte byte : payload_.take(position - payload_.position()))
        require_here(byte == std::byte(0), "the gap between two sections is not zero");
    }
  }
  // Bytes that open() has looked at.
  void pass(uint64_t position) {
    while (payload_.position() < position) payload_.take(position - payload_.position());
  }

  template <class Key>
  void scan(int level) {
    const RunSection& section = run_.layout().levels[level];
    skip_to(section.begin);
    std::optional<Key> last;
    while (payload_.position() < section.end) {
      const auto piece = payload_.take(section.end - payload_.position());
      const std::span keys(reinterpret_cast<const Key*>(piece.data()), piece.size() / sizeof(Key));
      for (const Key& key : keys) {
        // No key is as small as Key{}: that would be an empty one.
        require_here(last.value_or(Key{}) < key, "nodes are empty or do not ascend");
        last = key;
        mark(level, key);
      }
    }
  }

  void mark(int, Brick) {}
  void mark(int, const NodeKey& key) {
    for (const uint32_t child : key) {
      require_here(child <= marks_.size(), "a child is outside of the run");
      if (child != 0) marks_[child - 1] = true;
    }
  }

  // Begins the marks of `level`.
  void mark_roots(int level) {
    marks_ = {};
    marked_.resize(run_.keys(level) / 8, kPurpose);
    marks_.resize(run_.keys(level));
    for (const CellRoot& root : run_.roots()) {
      if (root.level == level) marks_[root.rank] = true;
    }
  }
  void require_all_marked(int level) {
    require(std::find(marks_.begin(), marks_.end(), false) == marks_.end(),
            "a node is not reached from any root",
            offset_of(run_.layout().levels[level].begin));
  }

  const RunFile& run_;
  Payload payload_;
  std::vector<bool> marks_;  // [rank], of the level below the one that is scanned
  MemoryBudget::Reservation marked_;
};

}  // namespace

void check_run(const RunFile& run, MemoryBudget* budget) {
  Check(run, budget).run();
}

}  // namespace svdag
