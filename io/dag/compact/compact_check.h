// Checks the structure of a file in the compact layout, so that a reader may follow its references
// without checks. For programs without any library, too.
//
// Invariants of a level with n nodes, m below it: the entry's classes have m nodes, the sizes of
// the parts follow from the entry and fill the section; every node has a child and the rest of the
// last line is zero; the base table has the running number of references to each class, and the
// totals are those of the entry; every stored reference is less than the size of its class, and the
// padding is zero. The number of references to private nodes is the number of private nodes, so the
// references that are not stored are valid.
#pragma once

#include <optional>

#include "io/dag/compact_view.h"

namespace svdag {

struct StructureDefect {
  const char* sentence;
  uint64_t offset;  // in the file
};

class CompactCheck {
 public:
  // `data`: the whole file, whose header is valid and whose sections are inside of it.
  explicit CompactCheck(const void* data)
      : base_(static_cast<const unsigned char*>(data)), h_(*static_cast<const Header*>(data)) {}

  std::optional<StructureDefect> run() const {
    const uint64_t bricks = h_.sections[h_.levels - 2].nodes;
    if (!has_possible_roots(h_)) return {{"wrong number of roots", h_.sections[0].offset}};
    for (uint32_t level = 0; level + 2 < h_.levels; ++level) {
      if (const auto defect = check_level(h_.sections[level], h_.sections[level + 1].nodes))
        return defect;
    }
    const Section& section = h_.sections[h_.levels - 2];
    if (section.bytes != bricks * 8)
      return {{"a level and the header differ in the number of nodes", section.offset}};
    const auto* brick = reinterpret_cast<const uint64_t*>(base_ + section.offset);
    for (uint64_t i = 0; i < bricks; ++i) {
      if (brick[i] == 0) return {{"an empty brick", section.offset + 8 * i}};
    }
    return std::nullopt;
  }

 private:
  std::optional<StructureDefect> check_level(const Section& section, uint64_t below) const {
    const uint64_t at = section.offset;
    if (section.nodes == 0) {
      if (section.bytes == 0 && below == 0) return std::nullopt;
      return {{"an empty level", at}};
    }
    if (section.nodes > kMaxWords || below > kMaxWords || section.bytes < sizeof(CompactEntry))
      return {{"impossible section size", at}};
    const CompactEntry& e = *reinterpret_cast<const CompactEntry*>(base_ + at);
    if (!is_possible(e, section, below)) return {{"an impossible entry of a level", at}};
    const CompactLevel level(&e, section.nodes);
    uint64_t references[kClasses] = {};
    for (uint64_t line = 0; line < compact_lines(section.nodes); ++line) {
      const uint64_t* const m0 = level.lines + line * 8;
      const uint32_t* const base = level.bases + line * kClasses;
      for (uint32_t s = 0; s < kClasses; ++s) {
        if (base[s] != references[s]) return {{"a wrong number in a base table", offset(base + s)}};
      }
      for (uint32_t i = 0; i < 4; ++i) {
        references[0] += popcount64(m0[i] & ~m0[4 + i]);
        references[1] += popcount64(~m0[i] & m0[4 + i]);
        references[2] += popcount64(m0[i] & m0[4 + i]);
      }
    }
    for (uint64_t i = 0; i < compact_lines(section.nodes) * kLineNodes; ++i) {
      if ((level.mask(uint32_t(i)) != 0) != (i < section.nodes))
        return {{"impossible child mask", offset(level.lines + i / kLineNodes * 8)}};
    }
    const auto* end =
        reinterpret_cast<const unsigned char*>(level.bases + 3 * compact_lines(section.nodes));
    if (!is_zero(end, level.streams[0])) return {{"padding is not zero", offset(end)}};
    for (uint32_t s = 0; s < kClasses; ++s) {
      if (references[s] != e.references[s]) return {{"a wrong number of references", at}};
      if (!has_stream(e, s)) continue;
      if (const auto defect = check_stream(level.streams[s], e, s)) return defect;
    }
    return std::nullopt;
  }

  static bool is_possible(const CompactEntry& e, const Section& section, uint64_t below) {
    bool possible = e.kind <= 1 && e.padding == 0 && e.reserved == 0;
    uint64_t nodes = 0;
    for (uint32_t s = 0; s < kClasses; ++s) {
      nodes += e.sizes[s];
      possible = possible && e.references[s] <= kMaxWords && e.widths[s] <= 32 &&
                 (has_stream(e, s) || (e.widths[s] == 0 && e.references[s] == e.sizes[s]));
    }
    return possible && nodes == below && compact_bytes(e, section.nodes) == section.bytes;
  }

  std::optional<StructureDefect> check_stream(const unsigned char* stream, const CompactEntry& e,
                                              uint32_t s) const {
    const uint32_t width = e.widths[s];
    for (uint64_t t = 0; t < e.references[s]; ++t) {
      if (stream_bits(stream, t * width, width) >= e.sizes[s])
        return {{"a reference does not lead to a node", offset(stream + t * width / 8)}};
    }
    const uint64_t bits = e.references[s] * width;
    const unsigned char* const end = stream + (bits + 7) / 8;
    const bool rest = bits % 8 != 0 && end[-1] >> (bits % 8) != 0;
    if (rest || !is_zero(end, stream + stream_bytes(e, s)))
      return {{"padding is not zero", offset(end)}};
    return std::nullopt;
  }

  static bool is_zero(const unsigned char* from, const unsigned char* to) {
    for (; from != to; ++from) {
      if (*from != 0) return false;
    }
    return true;
  }
  uint64_t offset(const void* at) const {
    return uint64_t(static_cast<const unsigned char*>(at) - base_);
  }

  const unsigned char* base_;
  const Header& h_;
};

}  // namespace svdag
