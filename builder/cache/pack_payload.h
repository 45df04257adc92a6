// The payload of a pack, between its header and its checksums: written and read in order, in blocks
// of 64 KiB with a checksum each.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/file.h"

namespace svdag {

constexpr uint64_t kPackBegin = 256;  // offset of the first block in the file
constexpr uint64_t kPackBlock = 65536;
constexpr uint64_t kPackAlignment = 64;  // of sections, relative to kPackBegin

// The bytes of a pack differ from those that were written. Any other Error (no file descriptor
// left, a file server that does not answer) does not mean that the pack is damaged.
class DamagedPack : public Error {
 public:
  DamagedPack(const std::string& path, const std::string& sentence,
              std::optional<uint64_t> offset = {})
      : Error(ExitCode::kBadInput, sentence, path, offset) {}
};

constexpr uint64_t align_pack(uint64_t position) {
  return (position + kPackAlignment - 1) / kPackAlignment * kPackAlignment;
}

class PackBlockWriter {
 public:
  explicit PackBlockWriter(AtomicFile* file) : file_(file), block_(kPackBlock) {}
  void append(std::span<const std::byte> bytes);
  // Appends zeros up to the next possible start of a section.
  void align();
  // Writes the last block and the checksums; returns the file size.
  uint64_t finish();

 private:
  void flush();

  AtomicFile* file_;
  std::vector<std::byte> block_;
  size_t filled_ = 0;
  std::vector<uint64_t> checksums_;
};

// Passes bytes `begin` .. `end` (relative to kPackBegin) of `file` to `use`, in chunks. Chunks
// begin at multiples of 64 bytes if `begin` does. DamagedPack if a block does not match its
// checksum.
void read_pack(const File& file, std::span<const uint64_t> checksums, uint64_t payload,
               uint64_t begin, uint64_t end, const std::function<void(std::span<std::byte>)>& use);

}  // namespace svdag
