// Makes a damaged packed file look genuine: recomputes its checksums, as a hostile writer would.
#pragma once

#include <cstring>
#include <span>
#include <string>

#include "io/dag/pack/pack_format.h"
#include "streaming/file/checksum.h"

namespace svdag {

inline void repair_packed(std::string* bytes) {
  PackedHeader h;
  if (bytes->size() < sizeof h) return;
  std::memcpy(&h, bytes->data(), sizeof h);
  const auto part = [&](uint64_t begin, uint64_t size) {
    return std::as_bytes(std::span(bytes->data() + begin, size));
  };
  if (h.index_offset <= bytes->size()) {
    for (uint64_t at = h.index_offset; bytes->size() - at >= sizeof(ChunkEntry);
         at += sizeof(ChunkEntry)) {
      ChunkEntry entry;
      std::memcpy(&entry, bytes->data() + at, sizeof entry);
      if (entry.offset > bytes->size() || entry.bytes > bytes->size() - entry.offset) continue;
      entry.checksum = checksum64(part(entry.offset, entry.bytes));
      std::memcpy(bytes->data() + at, &entry, sizeof entry);
    }
    h.index_checksum = checksum64(part(h.index_offset, bytes->size() - h.index_offset));
  }
  h.plain.header_checksum =
      checksum64(std::as_bytes(std::span(&h.plain, 1)).first(offsetof(Header, header_checksum)));
  h.checksum = checksum64(std::as_bytes(std::span(&h, 1)).first(offsetof(PackedHeader, checksum)));
  std::memcpy(bytes->data(), &h, sizeof h);
}

}  // namespace svdag
