#include "builder/farm/plan_index.h"

#include "streaming/atomic_file.h"
#include "streaming/checksum.h"
#include "streaming/record.h"

namespace svdag {
namespace {

constexpr const char* kIndex = "index";

std::string hash_of(std::span<const std::byte> bytes) {
  Hasher128 hasher;
  hasher.update(bytes);
  return to_hex(hasher.digest());
}

}  // namespace

std::string save_index(const Plan& plan) {
  RecordWriter record;
  record.put(uint64_t(plan.block_bytes));
  record.put(uint64_t(plan.bins.size()));
  for (const TriangleBin& bin : plan.bins) {
    record.put(bin.cube);
    record.put(bin.range);
    record.put(bin.triangles);
    record.put(bin.stream.number);
    record.put(bin.stream.bytes);
    record.put(bin.stream.blocks);
  }
  AtomicFile file(plan.path(kIndex));
  file.append(record.bytes());
  file.commit();
  return hash_of(record.bytes());
}

void load_index(const std::string& hash, Plan* plan) {
  const File file = File::open_read(plan->path(kIndex));
  std::vector<std::byte> bytes(file.size());
  file.read_at(0, bytes);
  if (hash_of(bytes) != hash)
    fail_input(file.path(), "is not the index of this plan: make the plan again");
  RecordReader in(bytes);
  uint64_t block_bytes = 0, bins = 0;
  in.get(&block_bytes);
  in.get(&bins);
  plan->block_bytes = block_bytes;
  plan->bins.clear();
  for (; bins > 0; --bins) {
    TriangleBin& bin = plan->bins.emplace_back();
    in.get(&bin.cube);
    in.get(&bin.range);
    in.get(&bin.triangles);
    in.get(&bin.stream.number);
    in.get(&bin.stream.bytes);
    in.get(&bin.stream.blocks);
  }
}

}  // namespace svdag
