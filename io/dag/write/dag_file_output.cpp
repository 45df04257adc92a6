#include "io/dag/write/dag_file_output.h"

#include <cstring>
#include <vector>

#include "io/dag/metadata.h"
#include "streaming/file/checksum.h"

namespace svdag {

DagFileOutput::DagFileOutput(const std::string& path) : file_(path) {
  const Header header{};
  file_.write_at(0, std::as_bytes(std::span(&header, 1)));
}

void DagFileOutput::append(std::span<const std::byte> bytes) {
  blocks_.append(bytes, &filled_);
  store(&filled_);
}

void DagFileOutput::store(FilledBlocks* filled) {
  filled->write_all([this](FilledBlock& block) {
    file_.write_at(sizeof(Header) + block.number * kChecksumBlock, block.bytes());
    return checksum64(block.bytes());
  });
}

void DagFileOutput::align() {
  static constexpr std::byte kZeros[kSectionAlignment] = {};
  const uint64_t beyond = position() % kSectionAlignment;
  append(std::span(kZeros).first((kSectionAlignment - beyond) % kSectionAlignment));
}

void DagFileOutput::finish(Header* header) {
  align();
  const std::string json = metadata_of(*header);
  header->metadata_offset = position();
  header->metadata_bytes = json.size();
  append(std::as_bytes(std::span(json)));
  align();
  header->checksum_offset = position();
  blocks_.finish(&filled_);
  store(&filled_);
  const std::vector<uint64_t> checksums(blocks_.checksums().begin(), blocks_.checksums().end());
  header->checksum_bytes = checksums.size() * sizeof(uint64_t);
  header->file_bytes = header->checksum_offset + header->checksum_bytes;
  const auto table = std::as_bytes(std::span(checksums));
  file_.write_at(header->checksum_offset, table);

  const auto bytes = std::as_bytes(std::span(header, 1));
  const bool has_own = has_table_hash(*header);
  uint64_t* const target = has_own ? header->table_hash : header->content_hash;
  target[0] = target[1] = header->header_checksum = 0;
  Hasher128 hasher;
  if (!has_own) hasher.update(bytes);
  hasher.update(table);
  const Hash128 hash = hasher.digest();
  std::memcpy(target, hash.data(), sizeof hash);
  header->header_checksum = checksum64(bytes.first(offsetof(Header, header_checksum)));
  file_.write_at(0, bytes);
}

}  // namespace svdag
