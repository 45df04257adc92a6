#include "io/pack/node_streams.h"

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

// The number of the child that is "ascending", if any; 8: none.
unsigned ascending_child(unsigned mask, unsigned mask_before, unsigned equal) {
  const unsigned differing = (mask ^ mask_before) | (mask & ~equal);
  const unsigned first = unsigned(std::countr_zero(differing | 0x100U));
  return (mask & mask_before & ~equal) >> first & 1U ? first : 8;
}

void put(std::array<Stream, kNodeStreams>* streams, size_t first, uint32_t value) {
  for (size_t plane = 0; plane < 4; ++plane)
    (*streams)[first + plane].push_back(static_cast<unsigned char>(value >> (8 * plane)));
}

// The u32 of four planes; none if these differ in length.
std::optional<std::vector<uint32_t>> values_of(const std::array<Stream, kNodeStreams>& streams,
                                               size_t first) {
  std::vector<uint32_t> values(streams[first].size());
  for (size_t plane = 0; plane < 4; ++plane) {
    const Stream& bytes = streams[first + plane];
    if (bytes.size() != values.size()) return std::nullopt;
    for (size_t i = 0; i < values.size(); ++i) values[i] |= uint32_t(bytes[i]) << (8 * plane);
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
    const unsigned ascending = ascending_child(mask, mask_before, equal);
    context.begin_node();
    for (unsigned c = 0; c < 8; ++c) {
      const uint32_t child = node[c];
      if (child == 0) continue;
      if ((equal >> c & 1U) == 0) {
        if (c == ascending) {
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
                      std::vector<NodeKey>* nodes) {
  for (const size_t i : {kMasks, kEqual, kFollowed}) {
    if (streams[i].size() != count) return false;
  }
  const auto ascending = values_of(streams, kAscending), others = values_of(streams, kOther);
  if (!ascending || !others) return false;
  size_t next_ascending = 0, next_other = 0;
  nodes->assign(count, {});
  Context context;
  unsigned mask_before = 0;
  for (size_t n = 0; n < count; ++n) {
    const unsigned mask = streams[kMasks][n], equal = streams[kEqual][n];
    const unsigned followed = streams[kFollowed][n];
    if (((equal | followed) & ~mask) != 0 || (equal & followed) != 0) return false;
    const unsigned at = ascending_child(mask, mask_before, equal);
    context.begin_node();
    for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
      const unsigned c = unsigned(std::countr_zero(rest));
      uint32_t child = context.last(c);
      if ((equal >> c & 1U) == 0) {
        if (c == at) {
          if (next_ascending == ascending->size()) return false;
          child += 1 + (*ascending)[next_ascending++];
        } else if (followed >> c & 1U) {
          child = context.follower(c);
        } else {
          if (next_other == others->size()) return false;
          child = (*others)[next_other++];
        }
      }
      if (child == 0 || child > below) return false;
      (*nodes)[n][c] = child;
      context.add(c, child);
    }
    mask_before = mask;
  }
  return next_ascending == ascending->size() && next_other == others->size();
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
