// A set that numbers its members in the order of arrival: the heart of the reduction.
//
// A blocking look-up per key costs several cache misses, so keys are only collected at first: add()
// gives a key a *pending* handle, and resolve() later numbers all pending keys at once, with
// prefetches running ahead of the comparisons. Node streams in depth-first order repeat soon, so a
// small direct-mapped cache of pending keys precedes the table. The table uses open addressing over
// a number and 32 bits of the hash per slot; whole keys are compared, never hashes. Memory grows
// with the content and is counted. Rejected:
// std::unordered_map (a node per key, pointer chasing), a table of keys (moved whenever it grows).
//
// Notation: a handle is a number, or kPending + the position among the keys not yet resolved.
// Rejected as well: adding keys without a branch (the position of a key then waits for the
// comparison before it), a larger cache of pending keys (no difference).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "streaming/memory/segmented_array.h"

namespace svdag {

constexpr uint32_t kPending = 0x80000000U;

// `most`: members; 1 + any handle must fit u32.
template <class Key, class Hash, uint32_t most = 0x7ffffffdU>
class UniqueSet {
 public:
  explicit UniqueSet(MemoryBudget* budget)
      : budget_(budget), keys_(budget, kPurpose), reservation_(budget->reserve(0, kPurpose)) {}

  // The handle of `key`.
  uint32_t add(const Key& key) {
    if (recent_.empty()) recent_.assign(size_t(1) << kRecentBits, 0);
    uint32_t& recent = recent_[Hash()(key) >> (64 - kRecentBits)];
    if (recent < pending_.size() && same(pending_[recent], key)) return kPending | recent;
    recent = uint32_t(pending_.size());
    pending_.push_back(key);
    return kPending | recent;
  }

  // Pending keys may be rewritten (their children got numbers) before they are resolved.
  std::span<Key> pending() { return pending_; }

  // Numbers the pending keys: (*numbers)[i] for the handle kPending + i.
  void resolve(std::vector<uint32_t>* numbers) {
    const size_t count = pending_.size();
    numbers->resize(count);
    if (count == 0) return;
    make_room(keys_.size() + count);
    // Far ahead a slot is fetched, nearer the key that it points to.
    std::array<uint32_t, 4 * kAhead> tags;
    for (size_t i = 0; i < count + 2 * kAhead; ++i) {
      if (i < count) {
        tags[i % tags.size()] = tag_of(pending_[i]);
        __builtin_prefetch(&slots()[home(tags[i % tags.size()])]);
      }
      if (i >= kAhead && i - kAhead < count) {
        const uint64_t slot = slots()[home(tags[(i - kAhead) % tags.size()])];
        if (slot != 0) keys_.prefetch(uint32_t(slot) - 1);
      }
      if (i >= 2 * kAhead) {
        const size_t k = i - 2 * kAhead;
        (*numbers)[k] = insert(pending_[k], tags[k % tags.size()]);
      }
    }
    pending_.clear();
  }

  size_t size() const { return keys_.size(); }
  const Key& operator[](uint32_t number) const { return keys_[number]; }
  // Ends the life of the table; the keys stay. Nothing may be resolved after this.
  void forget_slots() {
    memory_ = HugePages();
    mask_ = 0;
    reservation_.resize(0, kPurpose);
  }
  // Returns the keys; the set is then empty.
  SegmentedArray<Key> take_keys() {
    forget_slots();
    return std::exchange(keys_, SegmentedArray<Key>(budget_, kPurpose));
  }

 private:
  static constexpr int kRecentBits = 12;
  static constexpr size_t kMinSlots = 1024;
  static constexpr size_t kAhead = 16;
  static constexpr const char* kPurpose = "node tables";

  // A slot holds 1 + a number, and above it the tag: 32 bits of the hash, whose first ones are the
  // slot's index, so that growing needs no key and goes through the slots in order.
  uint64_t* slots() const { return static_cast<uint64_t*>(memory_.data()); }
  // Keys have no padding; the compiler turns this into a few word comparisons.
  static bool same(const Key& a, const Key& b) {
    constexpr size_t kWords = sizeof(Key) / sizeof(uint64_t);
    uint64_t x[kWords], y[kWords], differing = 0;
    std::memcpy(x, &a, sizeof a);
    std::memcpy(y, &b, sizeof b);
    for (size_t i = 0; i < kWords; ++i) differing |= x[i] ^ y[i];
    return differing == 0;
  }
  static uint32_t tag_of(const Key& key) { return uint32_t(Hash()(key)); }
  size_t home(uint32_t tag) const { return size_t(uint64_t(tag) >> shift_); }

  uint32_t insert(const Key& key, uint32_t tag) {
    size_t at = home(tag);
    for (uint64_t slot = slots()[at]; slot != 0; slot = slots()[at]) {
      const uint32_t number = uint32_t(slot) - 1;
      if (slot >> 32 == tag && same(keys_[number], key)) return number;
      at = (at + 1) & mask_;
    }
    if (keys_.size() >= most)
      throw Error(ExitCode::kMemory,
                  "the cells of one worker need more than 2^31 - 3 nodes in one level: lower the "
                  "resolution");
    keys_.push_back(key);
    slots()[at] = uint64_t(tag) << 32 | keys_.size();
    return uint32_t(keys_.size() - 1);
  }

  // At most 5 of 8 slots are taken.
  void make_room(size_t members) {
    size_t size = memory_.data() != nullptr ? mask_ + 1 : kMinSlots;
    while (members * 8 > size * 5) size *= 2;
    if (size * sizeof(uint64_t) != memory_.bytes()) grow_slots(size);
  }

  // Spreads the slots over `size` slots, in place. Invariant: slots are in the order of their tags
  // except for probing, so home(tag) only moves up. From the last to the first, each maximal range
  // of taken slots is taken out and put back; from begin > 0 its slots move to 2 * begin or beyond,
  // so no slot that is still to be moved is in the way.
  void grow_slots(size_t size) {
    const size_t old_size = memory_.bytes() / sizeof(uint64_t);
    reservation_.resize(size * sizeof(uint64_t), kPurpose);
    memory_.grow(size * sizeof(uint64_t));
    mask_ = size - 1;
    shift_ = 33 - int(std::bit_width(size));
    std::vector<uint64_t> range, past_end;
    for (size_t end = old_size; end > 0;) {
      while (end > 0 && slots()[end - 1] != 0) range.push_back(std::exchange(slots()[--end], 0));
      for (const uint64_t slot : range) {
        size_t at = home(uint32_t(slot >> 32));
        while (at < size && slots()[at] != 0) ++at;
        at < size ? void(slots()[at] = slot) : past_end.push_back(slot);
      }
      range.clear();
      if (end > 0) --end;  // a free slot
    }
    for (const uint64_t slot : past_end) {
      size_t at = home(uint32_t(slot >> 32));
      while (slots()[at] != 0) at = (at + 1) & mask_;
      slots()[at] = slot;
    }
  }

  MemoryBudget* budget_;
  std::vector<Key> pending_;
  std::vector<uint32_t> recent_;  // by hash: positions in pending_
  SegmentedArray<Key> keys_;
  HugePages memory_;  // of the slots
  size_t mask_ = 0;   // slots - 1
  int shift_ = 0;     // 32 - log2(slots)
  MemoryBudget::Reservation reservation_;
};

}  // namespace svdag
