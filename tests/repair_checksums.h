// Makes a damaged `.svdag` look genuine: recomputes its checksums and hashes, as a hostile writer
// would.
#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <string>

#include "io/dag/format.h"
#include "streaming/file/checksum.h"

namespace svdag {

// What the header places outside of `bytes` stays as it is; so does a text shorter than a header.
inline void repair_checksums(std::string* bytes) {
  Header h;
  if (bytes->size() < sizeof h) return;
  std::memcpy(&h, bytes->data(), sizeof h);
  const auto part = [&](size_t begin, size_t size) {
    return std::as_bytes(std::span(bytes->data() + begin, size));
  };
  if (h.checksum_offset >= sizeof h && h.checksum_offset <= bytes->size() &&
      h.checksum_bytes <= bytes->size() - h.checksum_offset) {
    for (size_t i = 0; i < h.checksum_bytes / 8; ++i) {
      const size_t begin = sizeof h + i * kChecksumBlock;
      if (begin >= h.checksum_offset) break;
      const size_t size = std::min<size_t>(kChecksumBlock, h.checksum_offset - begin);
      const uint64_t sum = checksum64(part(begin, size));
      std::memcpy(bytes->data() + h.checksum_offset + 8 * i, &sum, 8);
    }
    const bool own_hash = has_table_hash(h);  // the content hash is another file's
    uint64_t* const of_table = own_hash ? h.table_hash : h.content_hash;
    if (!own_hash) of_table[0] = of_table[1] = h.header_checksum = 0;
    Hasher128 hasher;
    if (!own_hash) hasher.update(std::as_bytes(std::span(&h, 1)));
    hasher.update(part(h.checksum_offset, h.checksum_bytes));
    const Hash128 hash = hasher.digest();
    std::memcpy(of_table, hash.data(), sizeof hash);
  }
  const auto header = std::as_bytes(std::span(&h, 1));
  h.header_checksum = checksum64(header.first(offsetof(Header, header_checksum)));
  std::memcpy(bytes->data(), &h, sizeof h);
}

}  // namespace svdag
