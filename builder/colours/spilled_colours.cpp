#include "builder/colours/spilled_colours.h"

#include <algorithm>
#include <cstring>

namespace svdag {
namespace {

// A divisor of the payload of a block, so that blocks hold whole ones.
struct PackedColour {
  uint64_t morton;
  uint8_t level, flags;
  uint16_t linear[3];
};
static_assert(sizeof(PackedColour) == SpilledColours::kEntryBytes);
static_assert(64 % sizeof(PackedColour) == 0);

constexpr uint8_t kHasColour = 1, kIsConstant = 2;

}  // namespace

void SpilledColours::add(std::span<const CubeColour> entries) {
  if (!writer_) writer_.emplace(scratch_.runs(), scratch_.new_streams(), scratch_.budget());
  for (const CubeColour& entry : entries) {
    PackedColour packed{
        entry.morton,
        entry.level,
        uint8_t((entry.has_colour ? kHasColour : 0) | (entry.is_constant ? kIsConstant : 0)),
        {}};
    std::ranges::copy(entry.linear, packed.linear);
    writer_->append(std::as_bytes(std::span(&packed, 1)));
  }
}

SpillStream SpilledColours::cut() {
  if (!writer_) return {};
  streams_.push_back(writer_->finish());
  writer_.reset();
  return streams_.back();
}

std::span<const CubeColour> SpilledColours::next() {
  entries_.clear();
  std::span<std::byte> block;
  if (reader_) block = reader_->next();
  for (; block.empty() && next_ < streams_.size(); block = reader_->next())
    reader_.emplace(scratch_.runs(), streams_[next_++], scratch_.budget());
  for (size_t at = 0; at < block.size(); at += sizeof(PackedColour)) {
    PackedColour packed;
    std::memcpy(&packed, &block[at], sizeof packed);
    CubeColour& entry = entries_.emplace_back();
    entry = {packed.morton,
             packed.level,
             (packed.flags & kHasColour) != 0,
             (packed.flags & kIsConstant) != 0,
             {}};
    std::ranges::copy(packed.linear, entry.linear);
  }
  return entries_;
}

}  // namespace svdag
