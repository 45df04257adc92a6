// `sort_bench FOLDER LOG2 ROUNDS memory|disk`: sorts 2^LOG2 keys of 32 bytes by std::sort, STXXL
// and the external sort, with memory for all of them or for an eighth (with files in FOLDER); a
// line of CSV each.
//
// The keys are passed one by one from an array to the sorter and from the sorter to a check; all of
// this is timed. The sorters run in turns, ROUNDS times; the result is the minimum time of each.
// STXXL supports one kind of disk per process, a file or memory, so each kind is a separate call.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "streaming/file/file_folder.h"
#include "streaming/sort/external_sort.h"
#include "tests/bench/sort_keys.h"
#include "tests/bench/stop_watch.h"
#ifdef SVDAG_HAS_STXXL
#include "tests/bench/peers/stxxl.h"
#endif

namespace svdag::bench {
namespace {

struct Case {
  std::string folder;
  std::vector<Key> keys;
  Digest digest;
  uint64_t memory;
};

SortCost std_sort(const Case& c) {
  std::vector<Key> room;
  room.reserve(c.keys.size());
  const StopWatch watch;
  SortCheck check;
  for (const Key& key : c.keys) room.push_back(key);
  std::sort(room.begin(), room.end());
  for (const Key& key : room) check.add(key);
  SortCost cost = watch.cost();
  cost.right = check.matches(c.digest);
  return cost;
}

SortCost our_sort(const Case& c) {
  const StopWatch watch;
  SortCheck check;
  MemoryBudget budget(c.memory);
  ParallelExecutor executor(available_processors());
  const Folder folder = Folder::open_private(c.folder);
  const auto word = [](const Key& key, size_t i) { return key[i]; };
  ExternalSort<Key, decltype(word)> sort(
      {&budget, c.memory, &executor, [&] { return folder.create("sort_bench.spill"); }}, 8, word);
  for (const Key& key : c.keys) sort.push(key);
  sort.finish([&](std::span<const Key> keys) {
    for (const Key& key : keys) check.add(key);
  });
  SortCost cost = watch.cost();
  cost.written = sort.written_bytes();
  cost.read = sort.read_bytes();
  cost.right = check.matches(c.digest);
  folder.remove("sort_bench.spill");
  return cost;
}

// In a virtual machine the first access to memory that the host has not allocated takes longer than
// sorting it. So the memory that a sorter needs is touched and freed before each sort.
void warm_memory(uint64_t bytes) {
  const HugePages pages(bytes);
  for (uint64_t i = 0; i < bytes; i += 4096) static_cast<volatile std::byte*>(pages.data())[i] = {};
}

void keep_least(SortCost* least, const SortCost& cost) {
  if (least->wall == 0) *least = cost;
  least->right = least->right && cost.right;
  least->wall = std::min(least->wall, cost.wall);
  least->cpu = std::min(least->cpu, cost.cpu);
}

struct Sorter {
  const char* name;
  std::function<SortCost(const Case&)> sort;
};

bool compare(const std::string& kind, const char* memory, const Case& c,
             const std::vector<Sorter>& sorters, int rounds) {
  std::vector<SortCost> least(sorters.size());
  for (int round = 0; round < rounds; ++round) {
    for (size_t s = 0; s < sorters.size(); ++s) {
      warm_memory(c.memory);
      keep_least(&least[s], sorters[s].sort(c));
    }
  }
  bool right = true;
  const double keys = double(c.keys.size());
  for (size_t s = 0; s < sorters.size(); ++s) {
    const SortCost& cost = least[s];
    std::printf("%s,%s,%s,%.0f,%.3f,%.3f,%.1f,%.1f,%d\n", kind.c_str(), memory, sorters[s].name,
                keys, cost.wall, cost.cpu, double(cost.written) / keys, double(cost.read) / keys,
                int(cost.right));
    right = right && cost.right;
  }
  std::fflush(stdout);
  return right;
}

bool run(const std::string& folder, int log2, int rounds, bool disk) {
  const size_t count = size_t(1) << log2;
  const uint64_t bytes = count * sizeof(Key);
  bool right = true;
#ifdef SVDAG_HAS_STXXL
  stxxl_disk(disk ? folder + "/stxxl" : "", bytes + (uint64_t(256) << 20));
#endif
  for (const char* kind : {"random", "nodes"}) {
    // In memory STXXL with its parallel sort needs four times the size of the keys, svdag twice.
    Case c{folder, make_keys(kind, count), {}, disk ? bytes / 8 : 5 * bytes};
    for (const Key& key : c.keys) c.digest.add(key);
    std::vector<Sorter> sorters{{"svdag", our_sort}};
    if (!disk) sorters.push_back({"std::sort", std_sort});
#ifdef SVDAG_HAS_STXXL
    sorters.push_back(
        {"stxxl", [](const Case& of) { return stxxl_sort(of.keys, of.memory, of.digest); }});
#endif
    right = compare(kind, disk ? "1/8" : "all", c, sorters, rounds) && right;
  }
  return right;
}

}  // namespace
}  // namespace svdag::bench

int main(int argc, char** argv) {
  if (argc != 5) return std::fputs("usage: sort_bench FOLDER LOG2 ROUNDS memory|disk\n", stderr), 2;
  try {
    const bool disk = std::string(argv[4]) == "disk";
    return svdag::bench::run(argv[1], std::atoi(argv[2]), std::atoi(argv[3]), disk) ? 0 : 1;
  } catch (const svdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(error.code());
  }
}
