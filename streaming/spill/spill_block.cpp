#include "streaming/spill/spill_block.h"

#include <cstring>
#include <utility>

#include "streaming/error.h"
#include "streaming/file/checksum.h"

namespace svdag {
namespace {

struct Header {
  uint32_t magic = 0x50535653;  // "SVSP"
  uint32_t length = 0;
  uint64_t stream = 0;
  uint64_t index = 0;
  uint64_t checksum = 0;
  uint64_t zeros[4] = {};
};
static_assert(sizeof(Header) == kSpillHeader);
constexpr size_t kChecksum = offsetof(Header, checksum);

Header header_of(const SpillLabel& label) {
  Header header;
  header.length = label.length;
  header.stream = label.stream;
  header.index = label.index;
  return header;
}

}  // namespace

SpillBlock::SpillBlock(MemoryBudget* budget, size_t bytes)
    : reservation_(budget->reserve(bytes, "spill buffers")),
      data_(static_cast<std::byte*>(::operator new(bytes, std::align_val_t(kAlignment)))) {}

uint64_t seal_block(std::span<std::byte> block, const SpillLabel& label) {
  SVDAG_ASSERT(label.length <= block.size() - kSpillHeader);
  const Header header = header_of(label);
  std::memcpy(block.data(), &header, sizeof header);
  const std::span<std::byte> rest = block.subspan(kSpillHeader + label.length);
  if (!rest.empty()) std::memset(rest.data(), 0, rest.size());
  const uint64_t checksum = checksum64(block);
  std::memcpy(block.data() + kChecksum, &checksum, sizeof checksum);
  return checksum;
}

bool open_block(std::span<std::byte> block, const SpillLabel& label) {
  const uint64_t checksum = block_checksum(block);
  std::memset(block.data() + kChecksum, 0, sizeof checksum);
  const Header expected = header_of(label);
  return std::memcmp(block.data(), &expected, sizeof expected) == 0 &&
         checksum64(block) == checksum;
}

uint64_t block_checksum(std::span<const std::byte> block) {
  uint64_t checksum;
  std::memcpy(&checksum, block.data() + kChecksum, sizeof checksum);
  return checksum;
}

}  // namespace svdag
