// An append-only list of records that survives the process (after ninja's deps log).
//
// A record is kind u32, length u32 (bytes of the payload), checksum u64 (XXH3-64 of kind, length
// and payload), payload. append() returns when the record is on disk; the caller must have synced
// the data it refers to. Once append() has thrown, every further call throws the same: a record
// after an incomplete one would never be read, and after a failed fsync the content of the disk is
// unknown. Reading stops at the first incomplete or damaged record and truncates the file there: a
// killed process loses at most the record it was writing.
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
  // `file`: empty, or an earlier journal, open for reading and writing. Sets *records to its
  // complete records.
  Journal(File file, std::vector<JournalRecord>* records);

  // Error (kOutput) if writing fails or `payload` is larger than 2^30 bytes.
  void append(uint32_t kind, std::span<const std::byte> payload);

 private:
  void write(uint32_t kind, std::span<const std::byte> payload);

  File file_;
  uint64_t end_ = 0;
  std::exception_ptr failure_;  // of the first append that failed
};

}  // namespace svdag
