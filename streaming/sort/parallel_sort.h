// The parallel first phase of a sort: all workers together split an array into buckets by leading
// digits, in ascending order; each bucket is then sorted by one worker
// (streaming/sort/radix_sort.h).
//
// A bucket that is still large, because most records agree in a digit (most nodes have no first
// child), is split again.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "streaming/process/executor.h"
#include "streaming/sort/radix_sort.h"

namespace svdag {

// `count` records from `at` on, which agree in the key words before `first`. `other`: as much
// memory, which may be overwritten.
template <class Record>
struct SortBucket {
  Record* at;
  Record* other;
  size_t count;
  size_t first;
};

template <class Record, class Word>
class ParallelSplit {
 public:
  using Bucket = SortBucket<Record>;

  ParallelSplit(const RadixSort<Record, Word>& order, Executor* executor)
      : order_(order), executor_(executor) {}

  // Splits `whole` into ascending buckets of at most `max_records` records; more only if all are
  // equal. The records of a bucket may be in either array.
  std::vector<Bucket> split(Bucket whole, size_t max_records) {
    max_records_ = std::max<size_t>(max_records, 1);
    buckets_.clear();
    add(whole);
    return std::move(buckets_);
  }

 private:
  static constexpr int kMaxBits = 10;
  static constexpr size_t kValues = size_t(1) << kMaxBits;
  using Counts = std::array<size_t, kValues>;

  void add(const Bucket& bucket) {
    RadixDigit digit;
    if (bucket.count <= max_records_ || !find_digit(bucket, &digit)) {
      if (bucket.count > 0) buckets_.push_back(bucket);
      return;
    }
    const std::vector<size_t> begin = distribute(bucket, digit);
    for (size_t d = 0; d < digit.values(); ++d) {
      add({bucket.other + begin[d], bucket.at + begin[d], begin[d + 1] - begin[d], digit.word});
    }
  }

  // Runs task(chunk, records of the chunk), with one chunk per worker.
  template <class Task>
  void for_chunks(const Bucket& bucket, const Task& task) {
    const size_t chunks = executor_->workers();
    executor_->for_each(chunks, [&](size_t, size_t c) {
      const size_t begin = bucket.count * c / chunks, end = bucket.count * (c + 1) / chunks;
      task(c, std::span<const Record>(bucket.at + begin, end - begin));
    });
  }

  // As RadixSort::find_digit(), in parallel.
  bool find_digit(const Bucket& bucket, RadixDigit* digit) {
    std::vector<uint32_t> bits(executor_->workers());
    for (size_t w = bucket.first; w < order_.words(); ++w) {
      for_chunks(bucket, [&](size_t c, std::span<const Record> records) {
        bits[c] = order_.differing(records, *bucket.at, w);
      });
      uint32_t all = 0;
      for (const uint32_t b : bits) all |= b;
      if (all == 0) continue;
      const int width = std::clamp(int(std::bit_width(bucket.count)) - 12, 6, kMaxBits);
      *digit = order_.digit_at(w, all, width);
      return true;
    }
    return false;
  }

  // Moves the records to bucket.other, ordered by their digit. Returns where each value begins.
  std::vector<size_t> distribute(const Bucket& bucket, const RadixDigit& digit) {
    const size_t values = digit.values();
    std::vector<Counts> next(executor_->workers());  // [chunk][value]
    for_chunks(bucket, [&](size_t c, std::span<const Record> records) {
      next[c].fill(0);
      for (const Record& r : records) ++next[c][order_.value(r, digit)];
    });
    std::vector<size_t> begin(values + 1);
    size_t at = 0;
    for (size_t d = 0; d < values; ++d) {
      begin[d] = at;
      for (Counts& counts : next) at += std::exchange(counts[d], at);
    }
    begin[values] = at;
    for_chunks(bucket, [&](size_t c, std::span<const Record> records) {
      Counts& own = next[c];
      for (const Record& r : records) bucket.other[own[order_.value(r, digit)]++] = r;
    });
    return begin;
  }

  const RadixSort<Record, Word>& order_;
  Executor* executor_;
  size_t max_records_ = 1;
  std::vector<Bucket> buckets_;
};

// Divides a list of buckets into `parts` parts with about the same number of records. Returns the
// index of the first bucket of each part, and buckets.size() as the last element.
template <class Record>
std::vector<size_t> even_parts(std::span<const SortBucket<Record>> buckets, size_t parts) {
  size_t total = 0, before = 0;
  for (const auto& bucket : buckets) total += bucket.count;
  std::vector<size_t> begin{0};
  for (size_t b = 0; b < buckets.size(); ++b) {
    while (begin.size() < parts && before >= total * begin.size() / parts) begin.push_back(b);
    before += buckets[b].count;
  }
  begin.resize(parts, buckets.size());
  begin.push_back(buckets.size());
  return begin;
}

}  // namespace svdag
