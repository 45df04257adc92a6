// The colours of a chunk: at most 16,384 consecutive colours of a file, encoded by themselves and
// read at random, by host and CUDA code (docs/format.md, "Colours"). No dependencies.
//
// The colours are divided into runs of consecutive colours. A run is constant, a line between two
// ends with a weight of 1 to 4 bits per colour, raw, or without colour. A look-up is a binary
// search in the groups of 16 runs, at most 16 headers, and one read.
//
// A chunk consists of u32 words: the number of runs, a word per group, the headers of the runs, the
// payload. The headers and the payload are bits, the lowest first.
#pragma once

#include "../compact_view.h"

namespace svdag {

// Colours are r | g << 8 | b << 16, sRGB, 8 bits a channel.
constexpr uint32_t kNoColour = 0xffffffffU;

constexpr uint32_t kChunkColours = 16384;
constexpr uint32_t kGroupRuns = 16;
constexpr uint32_t kRunHeaderBits = 11;  // length - 1: 8 bits; kind: 3 bits
constexpr uint32_t kGroupRankBits = 14;  // the rest: offset of the payload, in units of 2 bits
constexpr uint32_t kMaxRun = 256;        // colours; of a long constant, units of 256 colours

// Kinds 2 to 5 are lines with weights of kind - 1 bits.
enum RunKind : uint32_t { kConstantRun = 0, kLongRun = 1, kLineRun = 2, kRawRun = 6, kNoRun = 7 };
constexpr uint32_t kRunKinds = 8;
constexpr uint32_t kColourBits = 24, kEndBits = 18;

SVDAG_HD inline bool is_line(uint32_t kind) {
  return kind >= kLineRun && kind < kRawRun;
}
// Bits per colour of the payload.
SVDAG_HD inline uint32_t bits_per_colour(uint32_t kind) {
  return is_line(kind) ? kind - 1 : kind == kRawRun ? kColourBits : 0;
}
// Bits of the payload before those of the colours.
SVDAG_HD inline uint32_t bits_per_run(uint32_t kind) {
  return kind <= kLongRun ? kColourBits : is_line(kind) ? 2 * kEndBits : 0;
}

// An end of a line has 6 bits a channel; these are its 8 bits.
SVDAG_HD inline uint32_t end_channel(uint32_t six_bits) {
  return six_bits << 2 | six_bits >> 4;
}
// A channel of the line from a to b at `weight` of `last`: (a (last - weight) + b weight) / last,
// rounded half up. `last` is 1, 3, 7 or 15. The product is the exact quotient (chunk_codec_test).
SVDAG_HD inline uint32_t line_channel(uint32_t a, uint32_t b, uint32_t weight, uint32_t last) {
  return ((a * (last - weight) + b * weight + last / 2) * (65535 / last + 1)) >> 16;
}

// `count` <= 32 bits from `bit` on. Reads the word of the first bit and the next one.
SVDAG_HD inline uint32_t bits_at(const uint32_t* words, uint64_t bit, uint32_t count) {
  const uint32_t* word = words + (bit >> 5);
  const uint64_t pair = word[0] | uint64_t(word[1]) << 32;
  return uint32_t(pair >> (bit & 31) & ((uint64_t(1) << count) - 1));
}

SVDAG_HD inline uint32_t chunk_groups(uint32_t runs) {
  return (runs + kGroupRuns - 1) / kGroupRuns;
}
SVDAG_HD inline uint32_t chunk_header_words(uint32_t runs) {
  return (runs * kRunHeaderBits + 31) / 32;
}

// A colour of a run whose payload begins at `bit`; `i`: its number in the run.
SVDAG_HD inline uint32_t run_colour(const uint32_t* words, uint32_t kind, uint64_t bit,
                                    uint32_t i) {
  if (kind == kNoRun) return kNoColour;
  if (kind <= kLongRun) return bits_at(words, bit, kColourBits);
  if (kind == kRawRun) return bits_at(words, bit + uint64_t(kColourBits) * i, kColourBits);
  const uint32_t a = bits_at(words, bit, kEndBits), b = bits_at(words, bit + kEndBits, kEndBits);
  const uint32_t width = kind - 1, last = (1U << width) - 1;
  const uint32_t weight = bits_at(words, bit + 2 * kEndBits + uint64_t(width) * i, width);
  uint32_t colour = 0;
  for (uint32_t c = 0; c < 3; ++c)
    colour |=
        line_channel(end_channel(a >> 6 * c & 63U), end_channel(b >> 6 * c & 63U), weight, last)
        << 8 * c;
  return colour;
}

SVDAG_HD inline uint32_t run_length(uint32_t header) {
  return ((header & 255U) + 1) << (header >> 8 == kLongRun ? 8 : 0);
}

// Colour number `rank` of a valid chunk. The word after the chunk must be readable.
SVDAG_HD inline uint32_t chunk_colour(const uint32_t* words, uint32_t rank) {
  constexpr uint32_t kRankMask = (1U << kGroupRankBits) - 1;
  const uint32_t runs = words[0], groups = chunk_groups(runs);
  const uint32_t* group = words + 1;
  uint32_t low = 0;
  for (uint32_t high = groups; high - low > 1;) {
    const uint32_t middle = (low + high) / 2;
    ((group[middle] & kRankMask) <= rank ? low : high) = middle;
  }
  uint32_t i = rank - (group[low] & kRankMask);
  uint64_t header = 32 * uint64_t(1 + groups) + uint64_t(kRunHeaderBits * kGroupRuns) * low;
  uint64_t bit = 32 * uint64_t(1 + groups + chunk_header_words(runs)) +
                 2 * uint64_t(group[low] >> kGroupRankBits);
  for (;;) {
    const uint32_t run = bits_at(words, header, kRunHeaderBits);
    const uint32_t kind = run >> 8, length = run_length(run);
    if (i < length) return run_colour(words, kind, bit, i);
    i -= length;
    bit += bits_per_run(kind) + uint64_t(bits_per_colour(kind)) * length;
    header += kRunHeaderBits;
  }
}

}  // namespace svdag
