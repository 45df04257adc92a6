#include "builder/merge/rank_maps.h"

#include <algorithm>

namespace svdag {
namespace {

constexpr const char* kMapsPurpose = "maps of the merge";

std::span<const uint32_t> next_indices(SpillReader* reader) {
  const std::span<std::byte> block = reader->next();
  return {reinterpret_cast<const uint32_t*>(block.data()), block.size() / sizeof(uint32_t)};
}

}  // namespace

RankMaps::RankMaps(std::span<const uint64_t> counts, Scratch* scratch, MemoryBudget* budget)
    : scratch_(scratch), budget_(budget) {
  for (const uint64_t count : counts) {
    if (scratch != nullptr) {
      writers_.emplace_back(scratch->transient(), scratch->new_streams(), budget);
      continue;
    }
    maps_.emplace_back();
    maps_.back().reservation = budget->reserve(count * sizeof(uint32_t), kMapsPurpose);
    maps_.back().indices.resize(count);
  }
}

void RankMaps::finish() {
  for (SpillWriter& writer : writers_) streams_.push_back(writer.finish());
  writers_.clear();
}

void RankMaps::append_composed(RankMaps* into, size_t member, const RankMaps& out_of,
                               size_t group) {
  SpillReader ranks(scratch_->transient(), into->streams_[member], budget_);
  SpillReader indices(scratch_->transient(), out_of.streams_[group], budget_);
  SpillWriter writer(scratch_->transient(), scratch_->new_streams(), budget_);
  std::span<const uint32_t> window = next_indices(&indices);
  uint64_t begin = 0;  // rank of window[0]
  for (auto block = next_indices(&ranks); !block.empty(); block = next_indices(&ranks)) {
    for (const uint32_t rank : block) {
      while (rank - begin >= window.size()) {
        begin += window.size();
        window = next_indices(&indices);
      }
      writer.append(std::as_bytes(window.subspan(rank - begin, 1)));
    }
  }
  streams_.push_back(writer.finish());
  into->free(member);
}

uint64_t RankMaps::resident_bytes() const {
  uint64_t bytes = 0;
  for (const RankMap& map : maps_) bytes += map.reservation.bytes();
  return bytes;
}

RankMap RankMaps::load(size_t source, uint64_t begin, uint64_t end) const {
  const SpillStream& stream = streams_[source];
  const uint64_t per_block = scratch_->transient()->payload_bytes() / sizeof(uint32_t);
  RankMap map;
  map.first = begin;
  const uint64_t length = std::min(end, count(source)) - begin;
  map.reservation = budget_->reserve(length * sizeof(uint32_t), kMapsPurpose);
  map.indices.resize(length);
  if (length == 0) return map;
  SpillReader reader(scratch_->transient(), stream, budget_, begin / per_block);
  uint64_t skip = begin % per_block;
  for (uint64_t loaded = 0; loaded < length; skip = 0) {
    const std::span<const uint32_t> block = next_indices(&reader).subspan(skip);
    const uint64_t n = std::min<uint64_t>(block.size(), length - loaded);
    std::copy_n(block.data(), n, map.indices.data() + loaded);
    loaded += n;
  }
  return map;
}

}  // namespace svdag
