#include "builder/run/run_format.h"

namespace svdag {
namespace {

constexpr uint64_t kBrickBytes = 8, kNodeBytes = 32;

}  // namespace

RunLayout::RunLayout(const RunHeader& header) {
  const auto add_section = [this](uint64_t bytes) {
    const uint64_t begin = (payload + kRunAlignment - 1) / kRunAlignment * kRunAlignment;
    payload = begin + bytes;
    return RunSection{begin, payload};
  };
  for (uint32_t k = header.levels - 1; k-- > 0;)
    levels[k] = add_section(header.keys[k] * (k + 2 == header.levels ? kBrickBytes : kNodeBytes));
  roots = add_section(header.roots * sizeof(StoredRoot));
  ranges = add_section(header.ranges * sizeof(StoredRange));
  layers = add_section(header.layers_bytes);
  if (header.layers_bytes == 0) layers = {payload = ranges.end, ranges.end};
  blocks = (payload + kRunPayload - 1) / kRunPayload;
  file_bytes = sizeof(RunHeader) + blocks * kSpillHeader + payload;
}

uint64_t run_number(const RunHeader& header, std::span<const StoredRange> ranges) {
  Hasher128 hasher;
  hasher.update(std::as_bytes(std::span(&header, 1)).first(offsetof(RunHeader, run)));
  hasher.update(std::as_bytes(ranges));
  return hasher.digest()[0];
}

Hash128 content_hash_of(RunHeader header, Hasher128* blocks) {
  header.content_hash[0] = header.content_hash[1] = header.header_checksum = 0;
  blocks->update(std::as_bytes(std::span(&header, 1)));
  return blocks->digest();
}

uint64_t checksum_of(const RunHeader& header) {
  return checksum64(
      std::as_bytes(std::span(&header, 1)).first(offsetof(RunHeader, header_checksum)));
}

}  // namespace svdag
