#include "tests/bench/peers/stxxl.h"

#include <stxxl/sorter>

#include "tests/bench/stop_watch.h"

namespace svdag::bench {
namespace {

// STXXL's default of 2 MB gives too few blocks for one pass over an eighth of the data.
constexpr unsigned kBlock = 1 << 19;

struct Less {
  bool operator()(const Key& a, const Key& b) const { return a < b; }
  static Key min_value() { return Key{}; }
  static Key max_value() {
    Key key;
    key.fill(UINT32_MAX);
    return key;
  }
};

}  // namespace

void stxxl_disk(const std::string& path, uint64_t bytes) {
  stxxl::disk_config disk(path, bytes, path.empty() ? "memory" : "syscall unlink direct=on");
  stxxl::config::get_instance()->add_disk(disk);
}

SortCost stxxl_sort(std::span<const Key> keys, uint64_t memory, const Digest& expected) {
  const stxxl::stats_data before(*stxxl::stats::get_instance());
  const StopWatch watch;
  SortCheck check;
  {
    stxxl::sorter<Key, Less, kBlock> sorter(Less(), memory);
    for (const Key& key : keys) sorter.push(key);
    sorter.sort();
    for (; !sorter.empty(); ++sorter) check.add(*sorter);
  }
  SortCost cost = watch.cost();
  const stxxl::stats_data moved = stxxl::stats_data(*stxxl::stats::get_instance()) - before;
  cost.written = moved.get_written_volume();
  cost.read = moved.get_read_volume();
  cost.right = check.matches(expected);
  return cost;
}

}  // namespace svdag::bench
