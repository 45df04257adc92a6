// The compact layout of an inner level, traced as it is, by host and CUDA code. No dependencies.
//
// Idea: most nodes have one parent, and a few have very many. So the nodes of a level are divided
// into three classes by the number of references to them, and a reference has the bits that its
// class needs:
//
//   A  kind kPrivate: the nodes with one reference, in the order of their parents. The n-th
//      reference to class A leads to node n of it, so nothing is stored.
//      kind kExplicit: the 2^wA most referenced nodes.
//   B  the 2^wB most referenced nodes of the rest
//   C  all others
//
// Nodes are numbered by class, and within a class (except private ones) in content order, that is,
// as in the plain layout. Node i is entry i % 32 of line i / 32, which has two bytes for it: m0 and
// m1. Bits c of both are the state of child c, m0 + 2 m1: 0 absent, 1 to 3 its class. The base
// table has the number of references to each class before each line, so that a reference is found
// by counting bits in one line:
//
//   t  = base + number of references to the class before it in the line
//   id = first number of the class + (private ? t : bits t w to (t + 1) w - 1 of the stream)
//
// Rejected, in percent of the plain file for sponza at 16K^3 (this: 43.0): pointers of the bits
// that a level needs 57.6, private and shared nodes only 50.2, widths per line 49.1, whole
// bytes 45.3. Mirrored subtrees (SSVDAG) would cost every step of a ray.
#pragma once

#include "format.h"

#if defined(__CUDACC__)
#define SVDAG_HD __host__ __device__
#else
#define SVDAG_HD
#endif

namespace svdag {

SVDAG_HD inline uint32_t popcount64(uint64_t v) {
#if defined(__CUDA_ARCH__)
  return uint32_t(__popcll(static_cast<long long>(v)));
#else
  return uint32_t(__builtin_popcountll(v));
#endif
}

// Sizes of the parts of a level's section, in bytes.
SVDAG_HD inline uint64_t compact_lines(uint64_t nodes) {
  return (nodes + kLineNodes - 1) / kLineNodes;
}
SVDAG_HD inline uint64_t padded(uint64_t bytes) {
  return (bytes + kSectionAlignment - 1) / kSectionAlignment * kSectionAlignment;
}
SVDAG_HD inline uint64_t base_table_bytes(uint64_t nodes) {
  return padded(compact_lines(nodes) * kClasses * sizeof(uint32_t));
}
SVDAG_HD inline bool has_stream(const CompactEntry& entry, uint32_t of_class) {
  return of_class > 0 || entry.kind == uint32_t(CompactKind::kExplicit);
}
SVDAG_HD inline uint64_t stream_bytes(const CompactEntry& entry, uint32_t of_class) {
  if (!has_stream(entry, of_class)) return 0;
  return padded((entry.references[of_class] * entry.widths[of_class] + 7) / 8 + kStreamReadable);
}
SVDAG_HD inline uint64_t compact_bytes(const CompactEntry& entry, uint64_t nodes) {
  uint64_t bytes =
      sizeof(CompactEntry) + compact_lines(nodes) * 2 * kLineNodes + base_table_bytes(nodes);
  for (uint32_t s = 0; s < kClasses; ++s) bytes += stream_bytes(entry, s);
  return bytes;
}

// `width` <= 32 bits of a stream, from bit `at` on.
SVDAG_HD inline uint32_t stream_bits(const unsigned char* stream, uint64_t at, uint32_t width) {
#if defined(__CUDA_ARCH__)  // which reads only aligned words
  const uint32_t* const words = reinterpret_cast<const uint32_t*>(stream) + (at >> 5);
  const uint32_t bits = __funnelshift_r(words[0], words[1], uint32_t(at & 31));
  return uint32_t(bits & ((uint64_t(1) << width) - 1));
#else
  uint64_t word = 0;
  __builtin_memcpy(&word, stream + (at >> 3), sizeof word);
  return uint32_t(word >> (at & 7) & ((uint64_t(1) << width) - 1));
#endif
}

struct CompactLevel {
  const uint64_t* lines = nullptr;  // per line: 4 words of m0, 4 words of m1
  const uint32_t* bases = nullptr;  // per line: 3
  const unsigned char* streams[kClasses] = {};
  uint32_t widths[kClasses] = {};
  uint32_t first[kClasses] = {};  // number of the first node of a class, in the level below
  bool has_private = false;       // A is private

  CompactLevel() = default;
  // `section`: of the level, with `nodes` nodes.
  CompactLevel(const void* section, uint64_t nodes) {
    const CompactEntry& entry = *static_cast<const CompactEntry*>(section);
    const unsigned char* at = static_cast<const unsigned char*>(section) + sizeof(CompactEntry);
    lines = reinterpret_cast<const uint64_t*>(at);
    at += compact_lines(nodes) * 2 * kLineNodes;
    bases = reinterpret_cast<const uint32_t*>(at);
    at += base_table_bytes(nodes);
    uint32_t before = 0;
    for (uint32_t s = 0; s < kClasses; ++s) {
      streams[s] = at;
      at += stream_bytes(entry, s);
      widths[s] = entry.widths[s];
      first[s] = before;
      before += entry.sizes[s];
    }
    has_private = entry.kind == uint32_t(CompactKind::kPrivate);
  }

  SVDAG_HD uint32_t mask(uint32_t node) const {
    const unsigned char* const line = line_bytes(node / kLineNodes);
    const uint32_t i = node % kLineNodes;
    return uint32_t(line[i]) | line[kLineNodes + i];
  }
  // 1 + the class of child c; 0: absent.
  SVDAG_HD uint32_t state(uint32_t node, unsigned c) const {
    const unsigned char* const line = line_bytes(node / kLineNodes);
    const uint32_t i = node % kLineNodes;
    return (uint32_t(line[i]) >> c & 1U) | (uint32_t(line[kLineNodes + i]) >> c & 1U) << 1;
  }
  // The child c, which exists.
  SVDAG_HD uint32_t child(uint32_t node, unsigned c) const {
    const uint32_t in_state = state(node, c), s = in_state - 1;
    const uint64_t* const m0 = lines + uint64_t(node / kLineNodes) * 8;
    const uint64_t not_0 = uint64_t(in_state & 1U) - 1, not_1 = uint64_t(in_state >> 1) - 1;
    const uint32_t bit = node % kLineNodes * 8 + c, last = bit / 64;
    uint32_t t = bases[uint64_t(node / kLineNodes) * kClasses + s];
    const auto here = [&](uint32_t i) { return (m0[i] ^ not_0) & (m0[4 + i] ^ not_1); };
    const uint64_t before = (uint64_t(1) << bit % 64) - 1;
#if defined(__CUDA_ARCH__)  // a warp's threads wait for each other, so all read all words at once
    for (uint32_t i = 0; i < 4; ++i)
      t += popcount64(here(i) & (i < last ? ~uint64_t(0) : i == last ? before : 0));
#else
    for (uint32_t i = 0; i < last; ++i) t += popcount64(here(i));
    t += popcount64(here(last) & before);
#endif
    if (s == 0 && has_private) return t;
    return first[s] + stream_bits(streams[s], uint64_t(t) * widths[s], widths[s]);
  }

 private:
  SVDAG_HD const unsigned char* line_bytes(uint32_t line) const {
    return reinterpret_cast<const unsigned char*>(lines + uint64_t(line) * 8);
  }
};

}  // namespace svdag
