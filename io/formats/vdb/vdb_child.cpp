// Runs OpenVDB's reader in a limited child process, because it checks few counts and allocates what
// a damaged count requests. With --sandbox the child can only compute.
#include <algorithm>
#include <cstring>
#include <new>
#include <string_view>
#include <vector>

#include "io/formats/sent_cubes.h"
#include "io/formats/vdb/vdb_decode.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {
namespace {

// Memory per byte of the file. The worst case is an isolated voxel: it costs OpenVDB a node of
// 271 KB, one of 34 KB and a leaf, for 9 KB of masks in the file, which are never compressed: a
// factor of 34. (Leaf values that compress to nothing give 16.) Twice that suffices for every valid
// file; a count that requires more is wrong.
constexpr uint64_t kMemoryPerByte = 64;
// For OpenVDB's type registry, the values of a node being unpacked, and blocks to send.
constexpr uint64_t kMinMemory = uint64_t(48) << 20;
// A DecodedGrid takes at most 64 times the bytes of the masks in the file.
constexpr uint64_t kGridBytesPerByte = 64;
constexpr uint64_t kMinGridBytes = uint64_t(1) << 20;

// One second per 64 KiB, as for scene decoders (io/scene/decoders/limited_decoder.h).
ChildLimits limits_for(uint64_t bytes, uint64_t machine, bool sandbox) {
  return {kMinMemory + std::min(bytes * kMemoryPerByte, machine), 30 + bytes / 65536, sandbox};
}

}  // namespace

std::unique_ptr<VdbGrid> read_vdb(const std::string& path, const std::string& name,
                                  const std::optional<ValueRange>& range, bool sandbox) {
  const File file = File::open_read(path);
  std::vector<std::byte> bytes(size_t(file.size()));
  file.read_at(0, bytes);
  constexpr std::string_view kNano = "NanoVDB";
  if (bytes.size() >= kNano.size() && std::memcmp(bytes.data(), kNano.data(), kNano.size()) == 0)
    fail_input(path,
               "is a NanoVDB file, which svdag cannot read: give the .vdb it was made from, or "
               "convert it with nanovdb_convert");
  const uint64_t machine = default_memory_limit();
  const ChildLimits limits = limits_for(bytes.size(), machine, sandbox);
  const bool enough = bytes.size() * kMemoryPerByte <= machine;
  const std::string out_of_memory =
      "OpenVDB needs more than " + format_bytes(limits.memory) +
      " to read it: " + (enough ? "its counts are wrong" : "this machine has less");
  auto grid = std::make_unique<DecodedGrid>(path, kMinGridBytes + bytes.size() * kGridBytesPerByte);
  run_limited(
      limits, path,
      [&](const BlockSink& send) {
        try {
          decode_vdb(path, bytes, name, range, send);
        } catch (const std::bad_alloc&) {
          fail_input(path, out_of_memory);
        }
      },
      [&](std::span<const std::byte> block) { grid->receive(block); });
  grid->finish();
  return grid;
}

}  // namespace svdag
