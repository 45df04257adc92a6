// Makes damaged run files, packs and journals look genuine: recomputes their checksums and numbers,
// as a hostile writer would. What a header places outside of the bytes stays as it is.
#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <string>

#include "builder/cache/cell_pack.h"
#include "builder/cache/cell_pack_file.h"
#include "builder/run/run_format.h"
#include "streaming/file/checksum.h"

namespace svdag {

inline std::span<std::byte> part_of(std::string* bytes, size_t begin, size_t size) {
  return std::as_writable_bytes(std::span(*bytes)).subspan(begin, size);
}

// The ranges of the header, if they are in one block.
inline std::vector<StoredRange> stored_ranges(std::string* bytes, const RunHeader& h) {
  std::vector<StoredRange> ranges;
  if (h.levels < 3 || h.levels > 20 || h.ranges > bytes->size() / sizeof(StoredRange)) return {};
  for (const uint64_t keys : h.keys) {
    if (keys > bytes->size()) return {};
  }
  if (h.roots > bytes->size()) return {};
  const RunSection section = RunLayout(h).ranges;
  const size_t at = sizeof h + section.begin + (section.begin / kRunPayload + 1) * kSpillHeader;
  if (section.bytes() == 0 || at > bytes->size() || section.bytes() > bytes->size() - at) return {};
  ranges.resize(h.ranges);
  std::memcpy(ranges.data(), bytes->data() + at, section.bytes());
  return ranges;
}

inline void repair_run(std::string* bytes) {
  RunHeader h;
  if (bytes->size() < sizeof h) return;
  std::memcpy(&h, bytes->data(), sizeof h);
  h.run = run_number(h, stored_ranges(bytes, h));
  Hasher128 sums;
  for (size_t at = sizeof h, i = 0; at + kSpillHeader < bytes->size(); at += kRunBlockBytes, ++i) {
    const size_t size = std::min<size_t>(kRunBlockBytes, bytes->size() - at);
    const uint64_t sum =
        seal_block(part_of(bytes, at, size), {h.run, i, uint32_t(size - kSpillHeader)});
    sums.update(std::as_bytes(std::span(&sum, 1)));
  }
  const Hash128 hash = content_hash_of(h, &sums);
  std::copy(hash.begin(), hash.end(), h.content_hash);
  h.header_checksum = checksum_of(h);
  std::memcpy(bytes->data(), &h, sizeof h);
}

// The payload of a pack is what its size leaves for blocks and their checksums.
inline void repair_pack(std::string* bytes) {
  CellPackHeader h;
  if (bytes->size() < sizeof h) return;
  std::memcpy(&h, bytes->data(), sizeof h);
  const size_t rest = bytes->size() - sizeof h;
  const size_t blocks = (rest + kPackBlock + 7) / (kPackBlock + 8);
  if (rest >= 8 * blocks) {
    const size_t payload = rest - 8 * blocks;
    for (size_t i = 0; i < blocks; ++i) {
      const size_t begin = std::min(payload, i * kPackBlock);
      const size_t size = std::min<size_t>(kPackBlock, payload - begin);
      const uint64_t sum = checksum64(part_of(bytes, sizeof h + begin, size));
      std::memcpy(bytes->data() + sizeof h + payload + 8 * i, &sum, 8);
    }
  }
  h.checksum =
      checksum64(std::as_bytes(std::span(&h, 1)).first(offsetof(CellPackHeader, checksum)));
  std::memcpy(bytes->data(), &h, sizeof h);
}

// The records of a journal, up to the first that does not fit.
inline void repair_journal(std::string* bytes) {
  for (size_t at = 0; at + 16 <= bytes->size();) {
    uint32_t length;
    std::memcpy(&length, bytes->data() + at + 4, 4);
    if (length > bytes->size() - at - 16) return;
    // The checksum is over kind, length and payload, as if they stood side by side.
    std::string record = bytes->substr(at, 8) + bytes->substr(at + 16, length);
    const uint64_t sum = checksum64(std::as_bytes(std::span(record)));
    std::memcpy(bytes->data() + at + 8, &sum, 8);
    at += 16 + length;
  }
}

}  // namespace svdag
