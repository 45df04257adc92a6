// Arbitrary bytes as a pack of the cell cache, unchanged and with repaired checksums: an Error, or
// cells that can be loaded.
#include "builder/cache/cell_pack.h"
#include "tests/fuzz/file_fuzz.h"
#include "tests/repair_files.h"

namespace svdag {
namespace {

constexpr size_t kMaxTaken = 64;

void try_pack(const std::string& bytes) {
  expect_only_errors([&] {
    const MemoryFile memory(bytes);
    MemoryBudget budget(uint64_t(64) << 20);
    CellPack pack(memory.file().path());
    pack.read_entries(&budget);
    pack.prove();
    for (size_t i = 0; i < std::min(pack.entries().size(), kMaxTaken); ++i) {
      const CellPackEntry& entry = pack.entries()[i];
      const int levels = entry.rank == kNoNode ? 3 : std::max(3, int(entry.height));
      if (levels > kMaxLevels) continue;
      const Cube cube{entry.rank == kNoNode ? 1 : levels - int(entry.height), {}};
      const BakedRun baked = pack.extract({{i, cube, kUnionSet}}, levels, &budget, nullptr);
      if ((entry.rank != kNoNode) != (baked.roots.size() == 1)) std::abort();
    }
  });
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  svdag::try_pack(bytes);
  if (size >= sizeof(svdag::CellPackHeader)) {
    const uint64_t file_bytes = size;
    std::memcpy(bytes.data() + offsetof(svdag::CellPackHeader, file_bytes), &file_bytes, 8);
  }
  svdag::repair_pack(&bytes);
  svdag::try_pack(bytes);
  return 0;
}
