#include "io/formats/sent_cubes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "streaming/error.h"

namespace svdag {
namespace {

// Sort key in the order of OpenVDB's tree: nodes of 4096^3 by x, y, z, in each the nodes of 128^3,
// in each the leaves. The cubes in an aligned larger cube are consecutive in this order.
using TreeKey = std::pair<uint64_t, uint32_t>;

TreeKey tree_key(const LatticePoint& p) {
  TreeKey key{0, 0};
  for (int a = 0; a < 3; ++a) {
    const uint64_t from_lowest = uint64_t(p[a] - std::numeric_limits<int32_t>::min());
    key.first = key.first << 20 | from_lowest >> 12;
  }
  for (int a = 0; a < 3; ++a) key.second = key.second << 5 | uint32_t(p[a] >> 7 & 31);
  for (int a = 0; a < 3; ++a) key.second = key.second << 4 | uint32_t(p[a] >> 3 & 15);
  return key;
}

LatticePoint point(const std::array<int32_t, 3>& p) {
  return {p[0], p[1], p[2]};
}

template <class Cube>
bool before(const Cube& a, const Cube& b) {
  return tree_key(point(a.origin)) < tree_key(point(b.origin));
}

template <class Cube>
bool contains(const Cube& cube, const LatticePoint& voxel) {
  const LatticePoint at = voxel - point(cube.origin);
  for (int a = 0; a < 3; ++a)
    if (at[a] < 0 || at[a] >= int64_t(cube.side)) return false;
  return true;
}

Block block_of(const CubeRecord& record) {
  Block block;
  block.words = record.words;
  return block;
}

bool is_printable(const std::string& name) {
  return std::none_of(name.begin(), name.end(),
                      [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

}  // namespace

void DecodedGrid::fail_malformed() const {
  fail_input(path_, "its decoder sent an invalid grid");
}

void DecodedGrid::receive(std::span<const std::byte> block) {
  if (!has_header_) return receive_header(block);
  if (block.size() % sizeof(CubeRecord) != 0) fail_malformed();
  for (; !block.empty(); block = block.subspan(sizeof(CubeRecord))) {
    CubeRecord record;
    std::memcpy(&record, block.data(), sizeof record);
    add(record);
  }
}

void DecodedGrid::receive_header(std::span<const std::byte> block) {
  CubeHeader header;
  if (block.size() < sizeof header) fail_malformed();
  std::memcpy(&header, block.data(), sizeof header);
  if (header.type > CubeValueType::kFloat || header.name_bytes > CubeHeader::kMaxNameBytes ||
      block.size() != sizeof header + header.name_bytes)
    fail_malformed();
  type_ = header.type;
  name_.assign(reinterpret_cast<const char*>(block.data()) + sizeof header, header.name_bytes);
  if (!is_printable(name_)) fail_malformed();
  for (int a = 0; a < 3; ++a) {
    centres_.origin[a] = header.origin[size_t(a)];
    for (int b = 0; b < 3; ++b) centres_.axes[size_t(a)][b] = header.axes[size_t(a)][size_t(b)];
  }
  for (int a = 0; a < 3; ++a) {
    bool finite = std::isfinite(centres_.origin[a]);
    for (const Point& axis : centres_.axes) finite = finite && std::isfinite(axis[a]);
    if (!finite) fail_input(path_, "grid " + name_ + " has a transform that is not finite");
  }
  has_header_ = true;
}

void DecodedGrid::add(const CubeRecord& record) {
  const int64_t side = record.side;
  bool valid = side == kBlockSide || side == 128 || side == 4096;
  const LatticePoint origin = point(record.origin);
  for (int a = 0; a < 3 && valid; ++a)
    valid = origin[a] % side == 0 && origin[a] + side - 1 <= std::numeric_limits<int32_t>::max();
  const bool leaf = side == kBlockSide && !(block_of(record) == Block::full());
  if (!valid || (leaf && block_of(record).empty()))
    fail_input(path_, "damaged file: a block is at an impossible position");
  const VoxelBox box{origin, origin + side};
  const bool first = tiles_.empty() && leaves_.empty();
  for (int a = 0; a < 3; ++a) {
    bounds_.min[a] = first ? box.min[a] : std::min(bounds_.min[a], box.min[a]);
    bounds_.max[a] = first ? box.max[a] : std::max(bounds_.max[a], box.max[a]);
  }
  if (leaf) {
    leaves_.push_back(record);
  } else {
    tiles_.push_back({record.origin, record.side});
  }
  if (tiles_.size() * sizeof(Tile) + leaves_.size() * sizeof(CubeRecord) > max_bytes_)
    fail_input(path_, "damaged file: it has more blocks than a file of its size can hold");
}

void DecodedGrid::finish() {
  if (!has_header_) fail_malformed();
  // Those of an intact file are in order, except that full leaves follow the other full cubes.
  if (!std::is_sorted(tiles_.begin(), tiles_.end(), before<Tile>))
    std::sort(tiles_.begin(), tiles_.end(), before<Tile>);
  if (!std::is_sorted(leaves_.begin(), leaves_.end(), before<CubeRecord>))
    std::sort(leaves_.begin(), leaves_.end(), before<CubeRecord>);
  check_overlap();
}

// In this order a cube within another one follows it directly, or follows another cube within it.
void DecodedGrid::check_overlap() const {
  bool overlap = false;
  for (size_t i = 1; i < tiles_.size(); ++i)
    overlap = overlap || contains(tiles_[i - 1], point(tiles_[i].origin));
  for (size_t i = 0; i < leaves_.size() && !overlap; ++i) {
    overlap = (i > 0 && leaves_[i].origin == leaves_[i - 1].origin) ||
              tile_at(point(leaves_[i].origin)) != nullptr;
  }
  if (overlap) fail_input(path_, "damaged file: two of its blocks hold the same voxels");
}

std::string DecodedGrid::type() const {
  return type_ == CubeValueType::kMask ? "mask" : type_ == CubeValueType::kBool ? "bool" : "float";
}

bool DecodedGrid::visit(const VoxelCubeSink& sink) const {
  for (const Tile& tile : tiles_) {
    const int64_t side = tile.side;
    if (!sink({point(tile.origin), side, side == kBlockSide ? Block::full() : Block()}))
      return false;
  }
  for (const CubeRecord& leaf : leaves_)
    if (!sink({point(leaf.origin), kBlockSide, block_of(leaf)})) return false;
  return true;
}

const DecodedGrid::Tile* DecodedGrid::tile_at(const LatticePoint& voxel) const {
  const auto behind = std::upper_bound(
      tiles_.begin(), tiles_.end(), tree_key(voxel),
      [](const TreeKey& key, const Tile& tile) { return key < tree_key(point(tile.origin)); });
  if (behind == tiles_.begin() || !contains(*(behind - 1), voxel)) return nullptr;
  return &*(behind - 1);
}

bool DecodedGrid::get(const LatticePoint& voxel) const {
  for (int a = 0; a < 3; ++a)
    if (voxel[a] < bounds_.min[a] || voxel[a] >= bounds_.max[a]) return false;
  if (tile_at(voxel) != nullptr) return true;
  const auto leaf = std::lower_bound(leaves_.begin(), leaves_.end(), tree_key(voxel),
                                     [](const CubeRecord& record, const TreeKey& key) {
                                       return tree_key(point(record.origin)) < key;
                                     });
  if (leaf == leaves_.end() || !contains(*leaf, voxel)) return false;
  return block_of(*leaf).get(unsigned(voxel.x & 7), unsigned(voxel.y & 7), unsigned(voxel.z & 7));
}

}  // namespace svdag
