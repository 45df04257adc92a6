#include "builder/cache/cell_pack_file.h"

#include <algorithm>
#include <cstring>

#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"

namespace svdag {

void CellPackWriter::append(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const size_t n = std::min(bytes.size(), block_.size() - filled_);
    std::memcpy(block_.data() + filled_, bytes.data(), n);
    bytes = bytes.subspan(n);
    filled_ += n;
    if (filled_ == block_.size()) flush();
  }
}

void CellPackWriter::align() {
  static constexpr std::byte kZeros[kPackAlignment] = {};
  append(std::span(kZeros).first(align_pack(filled_) - filled_));
}

void CellPackWriter::flush() {
  check_interrupt();
  const std::span<const std::byte> block = std::span(block_).first(filled_);
  file_->write_at(kPackBegin + checksums_.size() * kPackBlock, block);
  checksums_.push_back(checksum64(block));
  filled_ = 0;
}

uint64_t CellPackWriter::finish() {
  const uint64_t end = kPackBegin + checksums_.size() * kPackBlock + filled_;
  if (filled_ > 0) flush();
  const auto table = std::as_bytes(std::span(checksums_));
  file_->write_at(end, table);
  return end + table.size();
}

void read_cell_pack(const File& file, std::span<const uint64_t> checksums, uint64_t payload,
                    uint64_t begin, uint64_t end,
                    const std::function<void(std::span<std::byte>)>& use) {
  std::vector<std::byte> memory(std::min(kPackBlock, payload));
  for (uint64_t at = begin; at < end;) {
    check_interrupt();
    const uint64_t index = at / kPackBlock, first = index * kPackBlock;
    const std::span<std::byte> block =
        std::span(memory).first(std::min(kPackBlock, payload - first));
    file.read_at(kPackBegin + first, block);
    if (checksum64(block) != checksums[index])
      throw DamagedCellPack(file.path(), "is damaged: a block does not match its checksum",
                            kPackBegin + first);
    const uint64_t stop = std::min(end, first + block.size());
    use(block.subspan(at - first, stop - at));
    at = stop;
  }
}

}  // namespace svdag
