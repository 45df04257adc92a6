#include "io/formats/surfaces/surface.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <optional>
#include <span>

#include "io/formats/surfaces/tile_vertices.h"

namespace svdag {
namespace {

constexpr int kTile = 64;

using PlaneRows = std::array<uint64_t, kTile>;

// The voxels of a tile, and those beside it.
class TileVoxels {
 public:
  void clear() {
    rows_ = {};
    below_ = above_ = {};
  }

  // At most 8 x 8 x 8 voxels; `at`: of their corner, in the tile, or one block beside it.
  void add(const Block& block, const LatticePoint& at) {
    for (int x = 0; x < kBlockSide; ++x) {
      const int64_t i = at.x + x;
      if (i < -1 || i > kTile || block.words[size_t(x)] == 0) continue;
      for (int y = 0; y < kBlockSide; ++y) {
        const int64_t j = at.y + y;
        if (j < -1 || j > kTile) continue;
        const uint64_t bits = block.words[size_t(x)] >> (8 * y) & 0xff;
        if (at.z < 0)
          set_bit(&below_, i, j, bits >> 7);
        else if (at.z >= kTile)
          set_bit(&above_, i, j, bits & 1);
        else
          row(i, j) |= bits << at.z;
      }
    }
  }
  void fill() {
    for (int x = 0; x < kTile; ++x)
      for (int y = 0; y < kTile; ++y) row(x, y) = ~uint64_t(0);
  }

  // Whether a voxel of the tile is in its first (or last) layer along an axis, in these 8 x 8 rows
  // or, along z, columns.
  bool touches(int axis, bool last, int a, int b) const {
    uint64_t any = 0;
    if (axis == 2) {
      const int z = last ? kTile - 1 : 0;
      for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 8; ++y) any |= row(8 * a + x, 8 * b + y) >> z & 1;
      return any != 0;
    }
    const int layer = last ? kTile - 1 : 0;
    for (int k = 0; k < 8; ++k)
      any |= (axis == 0 ? row(layer, 8 * a + k) : row(8 * a + k, layer)) >> (8 * b) & 0xff;
    return any != 0;
  }

  // The bits z of the faces of a row in a direction.
  uint64_t faces(int x, int y, int direction) const {
    const uint64_t own = row(x, y);
    const auto bit = [&](const PlaneRows& plane) { return plane[size_t(x)] >> y & 1; };
    switch (direction) {
      case 0:
        return own & ~row(x - 1, y);
      case 1:
        return own & ~row(x + 1, y);
      case 2:
        return own & ~row(x, y - 1);
      case 3:
        return own & ~row(x, y + 1);
      case 4:
        return own & ~(own << 1 | bit(below_));
      default:
        return own & ~(own >> 1 | bit(above_) << (kTile - 1));
    }
  }

 private:
  static void set_bit(PlaneRows* plane, int64_t x, int64_t y, uint64_t bit) {
    if (std::min(x, y) >= 0 && std::max(x, y) < kTile) (*plane)[size_t(x)] |= bit << y;
  }
  uint64_t& row(int64_t x, int64_t y) { return rows_[size_t(x + 1)][size_t(y + 1)]; }
  uint64_t row(int64_t x, int64_t y) const { return rows_[size_t(x + 1)][size_t(y + 1)]; }

  std::array<std::array<uint64_t, kTile + 2>, kTile + 2> rows_{};
  PlaneRows below_{}, above_{};  // [x], bit y: the layers z = -1 and z = 64
};

// Finds and merges the faces of tiles.
class TileSurface {
 public:
  TileSurface(const VoxelWindow& window, const SurfaceConfig& config, const SurfaceSink& sink)
      : window_(window),
        config_(config),
        sink_(sink),
        has_colours_(config.colours && window.colours != nullptr) {}

  void add(const VoxelCube& cube) {
    if (cube.side > kTile) return add_large(cube);
    const LatticePoint tile = cube.origin >> LatticePoint(6);
    if (!tile_ || *tile_ != tile) begin(tile);
    const LatticePoint at = cube.origin - tile * int64_t(kTile);
    if (cube.side == kBlockSide) return voxels_.add(cube.block, at);
    const Block full = Block::full();
    for (int64_t x = 0; x < cube.side; x += kBlockSide)
      for (int64_t y = 0; y < cube.side; y += kBlockSide)
        for (int64_t z = 0; z < cube.side; z += kBlockSide)
          voxels_.add(full, at + LatticePoint(x, y, z));
  }
  SurfaceCounts finish() {
    end();
    return counts_;
  }

 private:
  void begin(const LatticePoint& tile) {
    end();
    tile_ = tile;
    voxels_.clear();
  }

  // The tiles inside have no faces.
  void add_large(const VoxelCube& cube) {
    const LatticePoint first = cube.origin >> LatticePoint(6);
    const int64_t n = cube.side / kTile;
    for (int64_t x = 0; x < n; ++x) {
      for (int64_t y = 0; y < n; ++y) {
        const bool is_wall = x == 0 || x == n - 1 || y == 0 || y == n - 1;
        for (int64_t z = 0; z < n; z += is_wall || z == n - 1 ? 1 : n - 1) {
          begin(first + LatticePoint(x, y, z));
          voxels_.fill();
        }
      }
    }
  }

  void end() {
    if (!tile_) return;
    add_border();
    tile_surface_ = {};
    vertices_.clear();
    for (int direction = 0; direction < 6; ++direction) {
      if (direction < 4)
        find_in_rows(direction);
      else
        find_in_columns(direction);
    }
    if (!tile_surface_.quads.empty()) sink_(tile_surface_);
    counts_.quads += tile_surface_.quads.size();
    counts_.vertices += tile_surface_.vertices.size();
    tile_.reset();
  }

  // The voxels beside the tile, where it has voxels at its border.
  void add_border() {
    const LatticePoint corner = *tile_ * int64_t(kTile);
    for (int axis = 0; axis < 3; ++axis) {
      const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
      for (const bool last : {false, true}) {
        for (int a = 0; a < 8; ++a) {
          for (int b = 0; b < 8; ++b) {
            if (!voxels_.touches(axis, last, a, b)) continue;
            LatticePoint at(0);
            at[axis] = last ? kTile : -kBlockSide;
            at[first] = 8 * a;
            at[second] = 8 * b;
            Block block = window_.walk->block(corner + at);
            block.cut(corner + at, window_.box());
            voxels_.add(block, at);
          }
        }
      }
    }
  }

  // Directions along x and y: a plane's rows are rows of the tile.
  void find_in_rows(int direction) {
    for (int depth = 0; depth < kTile; ++depth) {
      PlaneRows plane;
      for (int i = 0; i < kTile; ++i)
        plane[size_t(i)] =
            direction < 2 ? voxels_.faces(depth, i, direction) : voxels_.faces(i, depth, direction);
      merge(direction, depth, &plane);
    }
  }
  // Along z: a plane's rows are bits of many rows.
  void find_in_columns(int direction) {
    std::array<PlaneRows, kTile> planes{};
    for (int x = 0; x < kTile; ++x) {
      for (int y = 0; y < kTile; ++y) {
        for (uint64_t bits = voxels_.faces(x, y, direction); bits != 0; bits &= bits - 1)
          planes[size_t(std::countr_zero(bits))][size_t(x)] |= uint64_t(1) << y;
      }
    }
    for (int depth = 0; depth < kTile; ++depth) merge(direction, depth, &planes[size_t(depth)]);
  }

  void merge(int direction, int depth, PlaneRows* plane) {
    for (int i = 0; i < kTile; ++i) {
      counts_.faces += uint64_t(std::popcount((*plane)[size_t(i)]));
      if (has_colours_ && (*plane)[size_t(i)] != 0) find_colours(direction, depth, i, *plane);
    }
    for (int i = 0; i < kTile; ++i) {
      uint64_t& row = (*plane)[size_t(i)];
      while (row != 0) {
        const int first = std::countr_zero(row);
        const Colour colour = has_colours_ ? colours_[size_t(i)][size_t(first)] : Colour();
        const int length = config_.merge ? run_length(i, first, row, colour) : 1;
        const uint64_t run = (length == kTile ? ~uint64_t(0) : (uint64_t(1) << length) - 1)
                             << first;
        row &= ~run;
        int end = i + 1;
        for (; config_.merge && end < kTile; ++end) {
          uint64_t& next = (*plane)[size_t(end)];
          if ((next & run) != run || !has_colour(end, first, length, colour)) break;
          next &= ~run;
        }
        add_quad(direction, depth, {i, end}, {first, first + length}, colour);
      }
    }
  }

  // Of the faces from `first` on that are in one piece and of one colour.
  int run_length(int i, int first, uint64_t row, const Colour& colour) const {
    int length = std::countr_one(row >> first);
    if (!has_colours_) return length;
    int same = 1;
    while (same < length && colours_[size_t(i)][size_t(first + same)] == colour) ++same;
    return same;
  }
  bool has_colour(int i, int first, int length, const Colour& colour) const {
    if (!has_colours_) return true;
    const auto begin = colours_[size_t(i)].begin() + first;
    return std::all_of(begin, begin + length, [&](const Colour& c) { return c == colour; });
  }
  void find_colours(int direction, int depth, int i, const PlaneRows& plane) {
    for (uint64_t bits = plane[size_t(i)]; bits != 0; bits &= bits - 1) {
      const int j = std::countr_zero(bits);
      const LatticePoint at = voxel(direction, depth, i, j);
      colours_[size_t(i)][size_t(j)] =
          window_.colours->of({uint32_t(at.x), uint32_t(at.y), uint32_t(at.z)});
    }
  }

  // Of the plane's depth, row and bit.
  LatticePoint voxel(int direction, int depth, int i, int j) const {
    LatticePoint at = *tile_ * int64_t(kTile);
    const int axis = direction / 2;
    at[axis] += depth;
    at[axis == 0 ? 1 : 0] += i;
    at[axis == 2 ? 1 : 2] += j;
    return at;
  }

  struct Range {
    int begin, end;
  };
  void add_quad(int direction, int depth, Range rows, Range bits, const Colour& colour) {
    const bool is_upper = direction % 2 == 1;
    const LatticePoint corners[4] = {voxel(direction, depth + is_upper, rows.begin, bits.begin),
                                     voxel(direction, depth + is_upper, rows.end, bits.begin),
                                     voxel(direction, depth + is_upper, rows.end, bits.end),
                                     voxel(direction, depth + is_upper, rows.begin, bits.end)};
    // Rows and bits are y and z, x and z, or x and y: with x between, a left-handed order.
    const bool is_reversed = is_upper != (direction / 2 != 1);
    std::array<uint32_t, 4> quad;
    for (size_t k = 0; k < 4; ++k) {
      const LatticePoint& at = corners[is_reversed ? 3 - k : k];
      quad[k] = vertices_.number_of({{int32_t(at.x), int32_t(at.y), int32_t(at.z)}, colour},
                                    &tile_surface_.vertices);
    }
    tile_surface_.quads.push_back(quad);
  }

  const VoxelWindow& window_;
  const SurfaceConfig config_;
  const SurfaceSink& sink_;
  const bool has_colours_;
  std::optional<LatticePoint> tile_;
  TileVoxels voxels_;
  std::array<std::array<Colour, kTile>, kTile> colours_;  // of the faces of a plane
  TileVertices vertices_;
  SurfaceTile tile_surface_;
  SurfaceCounts counts_;
};

}  // namespace

SurfaceCounts visit_surface(const VoxelWindow& window, const SurfaceConfig& config,
                            const SurfaceSink& sink) {
  uint64_t voxels = 0;
  const auto surface = std::make_unique<TileSurface>(window, config, sink);
  window.walk->visit(window.box(), [&](const VoxelCube& cube) {
    check_interrupt();
    voxels += cube.count();
    surface->add(cube);
    return true;
  });
  SurfaceCounts counts = surface->finish();
  counts.voxels = voxels;
  return counts;
}

}  // namespace svdag
