#include "io/dag/pack/node_streams.h"

#include <bit>
#include <optional>

namespace svdag {
namespace {

enum : size_t { kMasks, kEqual, kFollowed, kAscending, kOther = kAscending + 4 };

// What is known of the nodes so far, for the packer and the unpacker.
class Context {
 public:
  void begin_node() { previous_ = 0; }
  uint32_t last(unsigned c) const { return last_[c]; }
  uint32_t follower(unsigned c) const { return followers_[slot(c)]; }
  void add(unsigned c, uint32_t child) {
    followers_[slot(c)] = child;
    last_[c] = previous_ = child;
  }

 private:
  static constexpr int kTableLog2 = 12;
  size_t slot(unsigned c) const { return (previous_ + c) * 2654435761U >> (32 - kTableLog2); }

  std::array<uint32_t, 8> last_{};
  std::vector<uint32_t> followers_ = std::vector<uint32_t>(size_t(1) << kTableLog2);
  uint32_t previous_ = 0;  // child of this node
};

// The lowest child at which a node differs from the one before it; 8 if at none.
unsigned first_difference(unsigned mask, unsigned mask_before, unsigned equal) {
  return unsigned(std::countr_zero((mask ^ mask_before) | (mask & ~equal) | 0x100U));
}

void put(std::array<Stream, kNodeStreams>* streams, size_t first, uint32_t value) {
  for (size_t plane = 0; plane < 4; ++plane)
    (*streams)[first + plane].push_back(static_cast<unsigned char>(value >> (8 * plane)));
}

// The u32 of four planes; none if these differ in length.
std::optional<std::vector<uint32_t>> values_of(const std::array<Stream, kNodeStreams>& streams,
                                               size_t first) {
  const size_t count = streams[first].size();
  std::vector<uint32_t> values(count);
  for (size_t plane = 0; plane < 4; ++plane) {
    const Stream& bytes = streams[first + plane];
    if (bytes.size() != count) return std::nullopt;
    for (size_t i = 0; i < count; ++i) values[i] |= uint32_t(bytes[i]) << (8 * plane);
  }
  return values;
}

}  // namespace

std::array<Stream, kNodeStreams> streams_of_nodes(std::span<const NodeKey> nodes) {
  std::array<Stream, kNodeStreams> streams;
  Context context;
  unsigned mask_before = 0;
  for (const NodeKey& node : nodes) {
    unsigned mask = 0, equal = 0, followed = 0;
    for (unsigned c = 0; c < 8; ++c) {
      mask |= unsigned(node[c] != 0) << c;
      equal |= unsigned(node[c] != 0 && node[c] == context.last(c)) << c;
    }
    const unsigned first = first_difference(mask, mask_before, equal);
    const unsigned ascending = mask & mask_before & (1U << first);  // its bit, if any
    context.begin_node();
    for (unsigned c = 0; c < 8; ++c) {
      const uint32_t child = node[c];
      if (child == 0) continue;
      if ((equal >> c & 1U) == 0) {
        if ((ascending >> c & 1U) != 0) {
          put(&streams, kAscending, child - context.last(c) - 1);
        } else if (child == context.follower(c)) {
          followed |= 1U << c;
        } else {
          put(&streams, kOther, child);
        }
      }
      context.add(c, child);
    }
    streams[kMasks].push_back(static_cast<unsigned char>(mask));
    streams[kEqual].push_back(static_cast<unsigned char>(equal));
    streams[kFollowed].push_back(static_cast<unsigned char>(followed));
    mask_before = mask;
  }
  return streams;
}

bool nodes_of_streams(const std::array<Stream, kNodeStreams>& streams, size_t count, uint64_t below,
                      ChunkNodes* nodes) {
  for (const size_t i : {kMasks, kEqual, kFollowed}) {
    if (streams[i].size() != count) return false;
  }
  const auto ascending_values = values_of(streams, kAscending);
  const auto other_values = values_of(streams, kOther);
  if (!ascending_values || !other_values) return false;
  const uint32_t* next_ascending = ascending_values->data();
  const uint32_t* const end_ascending = next_ascending + ascending_values->size();
  const uint32_t* next_other = other_values->data();
  const uint32_t* const end_other = next_other + other_values->size();

  nodes->masks = streams[kMasks];
  size_t children = 0;
  for (const unsigned char mask : nodes->masks) children += kChildCounts[mask];
  nodes->children.assign(children + 8, 0);
  uint32_t* out = nodes->children.data();
  Context context;
  unsigned mask_before = 0;
  bool in_range = true, ascend = true;
  for (size_t n = 0; n < count; ++n) {
    const unsigned mask = streams[kMasks][n], equal = streams[kEqual][n];
    const unsigned followed = streams[kFollowed][n];
    if (((equal | followed) & ~mask) != 0 || (equal & followed) != 0) return false;
    const unsigned first = first_difference(mask, mask_before, equal);
    const unsigned ascending = mask & mask_before & (1U << first);  // its bit, if any
    const unsigned other = mask & ~(equal | followed | ascending);
    if ((ascending != 0 && next_ascending == end_ascending) ||
        kChildCounts[other] > end_other - next_other)
      return false;
    ascend &= (mask >> first & 1U) != 0;
    context.begin_node();
    for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
      const unsigned c = unsigned(std::countr_zero(rest)), bit = rest & -rest;
      uint32_t child = context.last(c);
      if ((equal & bit) == 0) {
        if ((ascending & bit) != 0) {
          child += 1 + *next_ascending++;
          ascend &= child > context.last(c);
        } else {
          child = (followed & bit) != 0 ? context.follower(c) : *next_other++;
        }
      }
      in_range &= child - 1 < below;
      *out++ = child;
      context.add(c, child);
    }
    mask_before = mask;
  }
  nodes->ascend = ascend;
  return in_range && next_ascending == end_ascending && next_other == end_other;
}

std::array<Stream, kBrickStreams> streams_of_bricks(std::span<const Brick> bricks) {
  std::array<Stream, kBrickStreams> streams;
  for (size_t plane = 0; plane < 8; ++plane) {
    for (const Brick brick : bricks)
      streams[plane].push_back(static_cast<unsigned char>(brick >> (8 * plane)));
  }
  return streams;
}

bool bricks_of_streams(std::span<const Stream, kBrickStreams> streams, size_t count,
                       std::vector<Brick>* bricks) {
  bricks->assign(count, 0);
  for (size_t plane = 0; plane < 8; ++plane) {
    if (streams[plane].size() != count) return false;
    for (size_t i = 0; i < count; ++i) (*bricks)[i] |= Brick(streams[plane][i]) << (8 * plane);
  }
  return true;
}

}  // namespace svdag
