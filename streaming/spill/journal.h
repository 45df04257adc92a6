// An append-only list of records that survives the process (after ninja's deps log).
//
// A record is kind u32, length u32, checksum u64 (XXH3-64 of kind, length and payload), payload.
// append() returns after the record is on disk; the caller has synced the data it refers to. After
// append() has thrown, it throws again: a record after an incomplete one is never read, and after a
// failed fsync the content of the disk is unknown. Reading stops at the first incomplete record and
// truncates the file there: a killed process loses at most the record it was writing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "streaming/file/file.h"

namespace svdag {

struct JournalRecord {
  uint32_t kind = 0;
  std::vector<std::byte> payload;
};

class Journal {
 public:
  // `file` is new and empty, or an earlier journal, of which *records gets what is whole.
  Journal(File file, std::vector<JournalRecord>* records);

  // A payload of more than 2^30 bytes is an Error (kOutput).
  void append(uint32_t kind, std::span<const std::byte> payload);

 private:
  void write(uint32_t kind, std::span<const std::byte> payload);

  File file_;
  uint64_t end_ = 0;
  std::exception_ptr failure_;  // of an append
};

}  // namespace svdag
