// Checks the colours of a file, so that a reader may look colours up without checks. For programs
// without any library, too.
//
// Invariants: the entries of the directory ascend from 0; an entry is a colour, none, or a chunk;
// the chunks follow one another and fill their section; a chunk is as its headers say and has a
// colour for each of its numbers. Whether the DAG has as many colours is checked where they are
// counted (io/dag/colours/dag_colours.h), whether the entries are those of the definition by
// verify/integrity, whether the runs are the cheapest is not checked.
#pragma once

#include <optional>

#include "io/dag/colours/chunk_view.h"
#include "io/dag/compact/compact_check.h"

namespace svdag {

// What is wrong with the `count` words of a chunk of `colours` colours; nullptr if they are valid.
// Reads no other words.
inline const char* chunk_defect(const uint32_t* words, uint64_t count, uint64_t colours) {
  if (count == 0 || words[0] == 0 || words[0] > kChunkColours)
    return "a chunk of colours with an impossible number of runs";
  const uint32_t runs = words[0], groups = chunk_groups(runs);
  const uint64_t headers = 1 + uint64_t(groups), payload = headers + chunk_header_words(runs);
  if (payload > count) return "a chunk of colours that ends within its headers";
  uint64_t start = 0, bits = 0;
  for (uint32_t run = 0; run < runs; ++run) {
    if (run % kGroupRuns == 0) {
      bits += bits & 1;
      if (words[1 + run / kGroupRuns] != (start | bits / 2 << kGroupRankBits))
        return "a group of runs of colours with a wrong place";
    }
    uint32_t header = 0;  // bits_at() would read a word more
    for (uint32_t i = 0; i < kRunHeaderBits; ++i) {
      const uint64_t bit = uint64_t(run) * kRunHeaderBits + i;
      header |= (words[headers + bit / 32] >> bit % 32 & 1U) << i;
    }
    const uint32_t kind = header >> 8, length = run_length(header);
    start += length;
    bits += bits_per_run(kind) + uint64_t(bits_per_colour(kind)) * length;
    if (start > colours) return "a run of colours that is longer than its chunk";
  }
  if (start != colours) return "a chunk of colours that lacks colours";
  if (count != payload + (bits + 31) / 32) return "a chunk of colours of the wrong size";
  const auto has_rest = [&](uint64_t used, uint64_t last) {
    return used % 32 != 0 && words[last] >> used % 32 != 0;
  };
  if (has_rest(uint64_t(runs) * kRunHeaderBits, payload - 1) || has_rest(bits, count - 1))
    return "padding of a chunk of colours is not zero";
  return nullptr;
}

// `data`: a whole file with a valid header; the parts of its colours are inside of it.
inline std::optional<StructureDefect> colours_defect(const void* data) {
  const Header& h = *static_cast<const Header*>(data);
  if (!has_colours(h)) return {};
  const char* const base = static_cast<const char*>(data);
  const auto* entries = reinterpret_cast<const ColourEntry*>(base + h.directory_offset);
  const auto* words = reinterpret_cast<const uint32_t*>(base + h.chunks_offset);
  const uint64_t count = h.directory_bytes / sizeof(ColourEntry), word_count = h.chunks_bytes / 4;
  if ((count == 0) != (h.colour_count == 0) || (count > 0 && entries[0].first != 0))
    return {{"the directory of colours does not begin with the first", h.directory_offset}};
  uint64_t open = count;  // the last chunk, which ends where the next one begins
  uint64_t begin = 0;     // of its words
  const auto end_of = [&](uint64_t i) {
    return i + 1 < count ? entries[i + 1].first : h.colour_count;
  };
  const auto close = [&](uint64_t end) -> const char* {
    if (open == count) return end == 0 ? nullptr : "colours that belong to no chunk";
    if (end < begin || end > word_count) return "a chunk of colours at an impossible place";
    return chunk_defect(words + begin, end - begin, end_of(open) - entries[open].first);
  };
  for (uint64_t i = 0; i < count; ++i) {
    const uint64_t offset = h.directory_offset + i * sizeof(ColourEntry), value = entries[i].value;
    if (end_of(i) <= entries[i].first) return {{"numbers of colours do not ascend", offset}};
    if ((value & kChunkEntry) == 0) {
      if (value > 0xffffff && value != kNoColour) return {{"an impossible colour", offset}};
      continue;
    }
    const uint64_t at = value & ~kChunkEntry;
    if (const char* const sentence = close(at)) return {{sentence, h.chunks_offset + 4 * begin}};
    if (end_of(i) - entries[i].first > kChunkColours)
      return {{"a chunk of too many colours", offset}};
    open = i;
    begin = at;
  }
  if (const char* const sentence = close(word_count))
    return {{sentence, h.chunks_offset + 4 * begin}};
  return {};
}

}  // namespace svdag
