#include "builder/split/triangle_bins.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>

#include "builder/overlap/overlap.h"
#include "io/dag/format.h"
#include "io/lattice.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// 14 numbers of 10 bytes: distances, differences, kind and material.
constexpr size_t kMaxTriangleBytes = 140 + sizeof(TextureCorners);

uint8_t* put_code(uint64_t code, uint8_t* out) {
  for (; code >= 0x80; code >>= 7) *out++ = uint8_t(code | 0x80);
  *out++ = uint8_t(code);
  return out;
}

uint8_t* put(int64_t value, uint8_t* out) {
  return put_code(uint64_t(value) << 1 ^ uint64_t(value >> 63), out);
}

}  // namespace

TriangleBins::TriangleBins(const Grid& grid, const Cube& parent, int depth, SpillFile* file,
                           Scratch* scratch)
    : grid_(grid),
      parent_(parent),
      bin_level_(parent.level + depth),
      file_(file),
      scratch_(scratch),
      bins_(size_t(1) << (3 * depth)) {
  SVDAG_ASSERT(depth >= 1 && depth <= kMaxDepth && bin_level_ <= grid.levels - 2);
}

int TriangleBins::depth_for(uint64_t bytes, const Scratch& scratch, const Grid& grid,
                            const Cube& parent) {
  const int max_depth = std::min(kMaxDepth, grid.levels - 2 - parent.level);
  int depth = 1;
  while (depth < max_depth && scratch.block_bytes() << (3 * (depth + 1)) <= bytes) ++depth;
  return depth;
}

void TriangleBins::add(const LatticeTriangle& triangle, const CutRecord* cut) {
  const LatticeBox box = box_of(triangle);
  const int shift = Cube{bin_level_, {}}.side_log2(grid_.levels);
  LatticePoint first, last;
  for (int a = 0; a < 3; ++a) {
    const int64_t begin = parent_.coordinate[a] << (bin_level_ - parent_.level);
    const int64_t end = begin + (int64_t(1) << (bin_level_ - parent_.level)) - 1;
    first[a] = std::clamp(first_touched(box.min[a], shift), begin, end);
    last[a] = std::clamp(last_touched(box.max[a], shift), begin, end);
  }
  if (first == last) return append({bin_level_, first}, triangle, cut, box);
  deal(triangle, cut, make_setup(triangle), parent_);
}

void TriangleBins::deal(const LatticeTriangle& triangle, const CutRecord* cut,
                        const TriangleSetup& setup, const Cube& cube) {
  if (cube.level == bin_level_) return append(cube, triangle, cut, setup.box);
  const ListedTriangle entry{&setup, setup.edges};
  const int64_t side = int64_t(1) << cube.side_log2(grid_.levels);
  const ChildOverlap overlap = overlap_children(entry, cube.corner(grid_.levels), side);
  for (unsigned c = 0; c < 8; ++c) {
    if (overlap.touched >> c & 1) deal(triangle, cut, setup, cube.child(c));
  }
}

void TriangleBins::append(const Cube& cube, const LatticeTriangle& triangle, const CutRecord* cut,
                          const LatticeBox& box) {
  OpenBin& bin = bins_[morton(cube.coordinate) % bins_.size()];
  if (!bin.writer) {
    const int size_log2 = VertexFinder::size_log2(*scratch_->budget());
    bin.vertices.emplace(size_log2, scratch_->budget());
    bin.writer.emplace(file_, scratch_->new_streams(), scratch_->budget());
    bin.box = box;
    const auto byte = std::byte(size_log2);
    write(&bin, {&byte, 1});
  }
  bin.box.add(box);
  uint8_t bytes[kMaxTriangleBytes];
  uint8_t* end = bytes;
  const VertexRing& vertices = bin.vertices->ring();
  const int64_t kind = 4 * int64_t(triangle.subject) + triangle.sheet;
  const bool is_kind_stored = kind != bin.kind || cut != nullptr;
  LatticePoint before = vertices.count() > 0 ? vertices[1] : LatticePoint(0);
  for (size_t i = 0; i < 3; ++i) {
    const uint64_t distance = bin.vertices->find_or_add(triangle.v[i]);
    end = put_code(i == 0 ? 2 * distance + is_kind_stored : distance, end);
    if (i == 0 && is_kind_stored) {
      end = put(cut == nullptr ? kind : ~kind, end);
      if (cut != nullptr) {
        end = put(cut->material, end);
        std::memcpy(end, &cut->corners, sizeof cut->corners);
        end += sizeof cut->corners;
      }
    }
    for (int a = 0; distance == 0 && a < 3; ++a)
      end = put(int64_t(uint64_t(triangle.v[i][a]) - uint64_t(before[a])), end);
    before = triangle.v[i];
  }
  bin.kind = kind;
  write(&bin, std::as_bytes(std::span(bytes, size_t(end - bytes))));
  ++bin.triangles;
}

void TriangleBins::write(OpenBin* bin, std::span<const std::byte> bytes) {
  bin->writer->append(bytes);
  bytes_ += bytes.size();
}

std::vector<TriangleBin> TriangleBins::finish() {
  std::vector<TriangleBin> bins;
  const uint64_t first = morton(parent_.coordinate) * bins_.size();
  for (uint64_t i = 0; i < bins_.size(); ++i) {
    OpenBin& bin = bins_[i];
    if (!bin.writer) continue;
    const Cube cube{bin_level_, unmorton(first + i)};
    bins.push_back(
        {shrink(cube, bin), morton_range(cube, grid_.levels), bin.triangles, bin.writer->finish()});
    bin.writer.reset();
    bin.vertices.reset();
  }
  return bins;
}

// The smallest cube that holds all voxels of `cube` that the triangle boxes touch.
Cube TriangleBins::shrink(const Cube& cube, const OpenBin& bin) const {
  const int f = grid_.fraction();
  const VoxelBox voxels = cube.voxels(grid_.levels);
  LatticePoint low, high;
  for (int a = 0; a < 3; ++a) {
    low[a] = std::clamp(first_touched(bin.box.min[a], f), voxels.min[a], voxels.max[a] - 1);
    high[a] = std::clamp(last_touched(bin.box.max[a], f), voxels.min[a], voxels.max[a] - 1);
  }
  Cube smallest = cube;
  for (int level = cube.level + 1; level <= grid_.levels - 2; ++level) {
    const int up = grid_.levels - level;
    for (int a = 0; a < 3; ++a) {
      if (low[a] >> up != high[a] >> up) return smallest;
    }
    smallest = {level, {low.x >> up, low.y >> up, low.z >> up}};
  }
  return smallest;
}

namespace {

// The snap rejects 2^62 steps and more before it moves a vertex by (2*k0 + 1) * 2^(F-1). A lattice
// grid is less than 2^38 voxels away from zero (io/grid.cpp), and its corner at most a voxel and a
// step of 1024 further: |2*k0 + 1| < 2^39 + 2^11, so with F <= 23 the move is less than 2^61 +
// 2^33. All vertices are moved by the same vector, so two of them differ by less than 2^63.
constexpr int64_t kMaxCoordinate = (int64_t(1) << 62) + (int64_t(1) << 61) + (int64_t(1) << 33);

// Whether the snap can have produced `t`. The voxelizer relies on it: differences do not overflow.
bool on_lattice(const LatticeTriangle& t) noexcept {
  const LatticeBox box = box_of(t);
  bool near = true;
  for (int a = 0; a < 3; ++a) {
    near &= box.min[a] >= -kMaxCoordinate && box.max[a] <= kMaxCoordinate &&
            uint64_t(box.max[a]) - uint64_t(box.min[a]) <= uint64_t(INT64_MAX);
  }
  return near;
}

}  // namespace

BinReader::BinReader(SpillFile* file, const TriangleBin& bin, MemoryBudget* budget,
                     size_t materials)
    : reader_(file, bin.stream, budget),
      budget_(budget),
      left_(bin.triangles),
      materials_(materials) {}

uint8_t BinReader::read_byte() {
  if (at_ == end_) {
    const std::span<std::byte> block = reader_.next();
    if (block.empty()) reader_.fail_damaged();
    at_ = reinterpret_cast<const uint8_t*>(block.data());
    end_ = at_ + block.size();
  }
  return *at_++;
}

uint64_t BinReader::read_code() {
  uint64_t code = 0;
  for (int shift = 0;; shift += 7) {
    if (shift > 63) reader_.fail_damaged();
    const uint8_t b = read_byte();
    code |= uint64_t(b & 0x7f) << shift;
    if (b < 0x80) return code;
  }
}

int64_t BinReader::read_number() {
  const uint64_t code = read_code();
  return int64_t(code >> 1) ^ -int64_t(code & 1);
}

LatticePoint BinReader::read_corner(uint64_t distance, const LatticePoint& before) {
  if (distance > 0) {
    if (!vertices_->holds(distance)) reader_.fail_damaged();
    return (*vertices_)[distance];
  }
  LatticePoint p;
  for (int a = 0; a < 3; ++a) p[a] = int64_t(uint64_t(before[a]) + uint64_t(read_number()));
  vertices_->add(p);
  return p;
}

CutRecord BinReader::read_cut() {
  CutRecord record;
  const int64_t material = read_number();
  if (material < 0 || uint64_t(material) >= materials_) reader_.fail_damaged();
  record.material = uint32_t(material);
  std::array<uint8_t, sizeof(TextureCorners)> bytes;
  for (uint8_t& byte : bytes) byte = read_byte();
  std::memcpy(&record.corners, bytes.data(), bytes.size());
  for (const TexturePoint& p : record.corners) {
    if (!is_placeable(p)) reader_.fail_damaged();
  }
  return record;
}

bool BinReader::read(size_t max_count, std::vector<LatticeTriangle>* out, CutRecords* cuts) {
  if (left_ == 0) return false;
  if (!vertices_) {
    const int size_log2 = read_byte();
    if (size_log2 < VertexRing::kMinLog2 || size_log2 > VertexRing::kMaxLog2)
      reader_.fail_damaged();
    vertices_.emplace(size_log2, budget_);
  }
  for (; max_count > 0 && left_ > 0; --max_count, --left_) {
    LatticeTriangle& t = out->emplace_back();
    const uint64_t code = read_code();
    if ((code & 1) != 0) {
      kind_ = read_number();
      if (kind_ < 0) {
        kind_ = ~kind_;
        t.cut = add_record(read_cut(), cuts) & kMaxCut;
      }
      if (kind_ > 4 * int64_t(kMaxLayers) + 3) reader_.fail_damaged();
    }
    const LatticePoint newest = vertices_->count() > 0 ? (*vertices_)[1] : LatticePoint(0);
    t.v[0] = read_corner(code >> 1, newest);
    for (size_t i = 1; i < 3; ++i) t.v[i] = read_corner(read_code(), t.v[i - 1]);
    if (!on_lattice(t)) reader_.fail_damaged();
    t.subject = uint32_t(kind_ >> 2);
    t.sheet = uint32_t(kind_) & kSheets;
  }
  return true;
}

}  // namespace svdag
