// OpenVDB reads files in a process of its own, because it checks few counts and allocates what a
// damaged count requests; with --sandbox, in a process that can only compute.
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

// A scattered voxel costs OpenVDB a node of 271 KB, one of 34 KB and a leaf, and the file their
// masks, of 9 KB, which are never compressed: 34 bytes of memory for one in the file. Nothing takes
// more of what is in a file (values of a leaf that compress to nothing: 16), so twice as much is
// enough for every file; a count that requires more is wrong.
constexpr uint64_t kMemoryPerByte = 64;
// For OpenVDB's lists of types, a node's values while they are unpacked, blocks to send.
constexpr uint64_t kMemoryAtLeast = uint64_t(48) << 20;
// As SentCubes keeps them, cubes take 64 times the masks in the file that say so, or less.
constexpr uint64_t kKeptPerByte = 64;
constexpr uint64_t kKeptAtLeast = uint64_t(1) << 20;

// As decoders of scenes have it (io/scene/readers/limited_decoder.h): a second for every 64 KiB.
ChildLimits limits_for(uint64_t bytes, uint64_t machine, bool sandbox) {
  return {kMemoryAtLeast + std::min(bytes * kMemoryPerByte, machine), 30 + bytes / 65536, sandbox};
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
               "is a NanoVDB file, which is only written: give the .vdb it was made of, or "
               "make one with nanovdb_convert");
  const uint64_t machine = default_memory_limit();
  const ChildLimits limits = limits_for(bytes.size(), machine, sandbox);
  const bool enough = bytes.size() * kMemoryPerByte <= machine;
  const std::string too_little =
      "OpenVDB needs more than " + format_bytes(limits.memory) +
      " for it: " + (enough ? "its counts are wrong" : "this machine has too little");
  auto grid = std::make_unique<SentCubes>(path, kKeptAtLeast + bytes.size() * kKeptPerByte);
  run_limited(
      limits, path,
      [&](const BlockSink& send) {
        try {
          decode_vdb(path, bytes, name, range, send);
        } catch (const std::bad_alloc&) {
          fail_input(path, too_little);
        }
      },
      [&](std::span<const std::byte> block) { grid->take(block); });
  grid->finish();
  return grid;
}

}  // namespace svdag
