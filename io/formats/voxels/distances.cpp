#include "io/formats/voxels/distances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "io/formats/voxels/npy_array.h"
#include "io/formats/voxels/zip.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr int64_t kBandTile = 64;
constexpr int16_t kFarSquare = 0x4000;  // no set voxel within N on the axes so far
static_assert(3 * kMaxDistance * kMaxDistance < kFarSquare);
static_assert(kFarSquare + 2 * kMaxDistance * kMaxDistance < INT16_MAX);

// The transform of one tile. Arrays are in the order x, y, z.
class TileDistances {
 public:
  explicit TileDistances(int limit)
      : limit_(limit),
        side_(kBandTile + 2 * limit),
        seeds_(size_t(side_ * side_ * side_)),
        along_z_(size_t(side_ * side_ * kBandTile)),
        along_y_(size_t(side_ * kBandTile * kBandTile)),
        has_z_(size_t(side_ * side_)),
        has_y_(size_t(side_ * kBandTile)) {}

  static uint64_t bytes(int limit) {
    const uint64_t side = uint64_t(kBandTile + 2 * limit), tile = kBandTile;
    return side * side * side + 2 * side * side * tile + 2 * side * tile * tile;
  }

  // Marks the set voxels of a tile and its border. Returns whether there are some.
  bool load(CubeWalk* walk, const VoxelBox& tile) {
    std::ranges::fill(seeds_, 0);
    const LatticePoint from = tile.min - LatticePoint(limit_);
    size_ = tile.max - tile.min;
    const VoxelBox box{from, tile.max + LatticePoint(limit_)};
    return for_each_voxel(walk, box, [&](const Voxel& v) {
             seeds_[size_t(((v[0] - from.x) * side_ + v[1] - from.y) * side_ + v[2] - from.z)] = 1;
           }) != 0;
  }
  void complement() {
    for (uint8_t& seed : seeds_) seed ^= 1;
  }

  // Passes visit(x, y, squares) each row of the tile.
  template <class Visit>
  void transform(const Visit& visit) {
    for (int64_t x = 0; x < size_.x + 2 * limit_; ++x)
      for (int64_t y = 0; y < size_.y + 2 * limit_; ++y) transform_z(x * side_ + y);
    for (int64_t x = 0; x < size_.x + 2 * limit_; ++x)
      for (int64_t y = 0; y < size_.y; ++y) {
        const size_t row = size_t(x * kBandTile + y);
        int16_t* const out = &along_y_[row * kBandTile];
        has_y_[row] = least(along_z_, has_z_, x * side_ + y + limit_, 1, out);
      }
    for (int64_t x = 0; x < size_.x; ++x)
      for (int64_t y = 0; y < size_.y; ++y) {
        std::array<int16_t, kBandTile> squares;
        least(along_y_, has_y_, (x + limit_) * kBandTile + y, kBandTile, squares.data());
        visit(x, y, squares);
      }
  }

 private:
  // The squares of distances along z, by a pass in each direction.
  void transform_z(int64_t number) {
    const uint8_t* seeds = &seeds_[size_t(number * side_)];
    int16_t* out = &along_z_[size_t(number * kBandTile)];
    const int64_t end = size_.z + 2 * limit_;
    bool some = false;
    int64_t away = limit_ + 1;
    for (int64_t z = 0; z < limit_ + size_.z; ++z) {
      away = seeds[z] != 0 ? 0 : away + 1;
      if (z >= limit_) out[z - limit_] = away <= limit_ ? int16_t(away) : kFarSquare;
    }
    away = limit_ + 1;
    for (int64_t z = end; z-- > limit_;) {
      away = seeds[z] != 0 ? 0 : away + 1;
      if (z >= limit_ + size_.z) continue;
      int16_t& d = out[z - limit_];
      if (away <= limit_) d = std::min(d, int16_t(away));
      if (d != kFarSquare) d = int16_t(d * d), some = true;
    }
    has_z_[size_t(number)] = some;
  }

  // Sets the row `out` to the least of i^2 and the rows from + i * step. False if all are far.
  bool least(const std::vector<int16_t>& rows, const std::vector<uint8_t>& has, int64_t from,
             int64_t step, int16_t* out) const {
    bool some = false;
    std::fill_n(out, kBandTile, kFarSquare);
    for (int64_t i = -limit_; i <= limit_; ++i) {
      const int64_t number = from + i * step;
      if (has[size_t(number)] == 0) continue;
      some = true;
      const int16_t square = int16_t(i * i);
      const int16_t* row = &rows[size_t(number * kBandTile)];
      for (int64_t z = 0; z < kBandTile; ++z) out[z] = std::min(out[z], int16_t(row[z] + square));
    }
    return some;
  }

  int64_t limit_, side_;
  LatticePoint size_{0};                    // of the tile
  std::vector<uint8_t> seeds_;              // of the tile with its border
  std::vector<int16_t> along_z_, along_y_;  // rows of squares
  std::vector<uint8_t> has_z_, has_y_;      // whether a row has some that are not far
};

// The signed squares of planes from .. from + thickness - 1 of the window; kFarSquare beyond the
// limit.
class DistancePlanes {
 public:
  DistancePlanes(const VoxelWindow& window, const DistanceConfig& config, MemoryBudget* budget)
      : window_(window),
        config_(config),
        size_(window.box().max - window.box().min),
        memory_(budget->reserve(TileDistances::bytes(config.limit), "distances")),
        tile_(config.limit) {
    const uint64_t plane = uint64_t(size_.y) * uint64_t(size_.z) * sizeof(int16_t);
    const uint64_t tile = memory_.bytes();
    thickness_ = std::min(kBandTile, size_.x);
    while (thickness_ > 1 && !memory_.try_resize(tile + plane * uint64_t(thickness_)))
      thickness_ = (thickness_ + 1) / 2;
    memory_.resize(tile + plane * uint64_t(thickness_), "distances");
    squares_.resize(size_t(plane / sizeof(int16_t)) * size_t(thickness_));
  }

  int64_t thickness() const { return thickness_; }

  // The next planes: x from `from` on, in voxels of the window.
  std::span<const int16_t> at(int64_t from) {
    const int64_t count = std::min(thickness_, size_.x - from);
    for (int64_t y = 0; y < size_.y; y += kBandTile)
      for (int64_t z = 0; z < size_.z; z += kBandTile) {
        const LatticePoint low(from, y, z);
        const LatticePoint side(count, std::min(kBandTile, size_.y - y),
                                std::min(kBandTile, size_.z - z));
        fill(low, side);
      }
    return std::span(squares_).first(size_t(count * size_.y * size_.z));
  }

 private:
  void fill(const LatticePoint& low, const LatticePoint& side) {
    const LatticePoint min = window_.box().min + low;
    const auto rows = [&](int64_t x, int64_t y) {
      return &squares_[size_t((x * size_.y + low.y + y) * size_.z + low.z)];
    };
    if (!tile_.load(window_.walk, {min, min + side})) {
      for (int64_t x = 0; x < side.x; ++x)
        for (int64_t y = 0; y < side.y; ++y) std::fill_n(rows(x, y), side.z, kFarSquare);
      return;
    }
    tile_.transform([&](int64_t x, int64_t y, const auto& squares) {
      std::copy_n(squares.begin(), side.z, rows(x, y));
    });
    if (!config_.is_signed) return;
    tile_.complement();
    tile_.transform([&](int64_t x, int64_t y, const auto& squares) {
      int16_t* row = rows(x, y);
      for (int64_t z = 0; z < side.z; ++z)
        if (row[z] == 0) row[z] = int16_t(-squares[size_t(z)]);
    });
  }

  const VoxelWindow& window_;
  const DistanceConfig& config_;
  LatticePoint size_;
  MemoryBudget::Reservation memory_;
  TileDistances tile_;
  int64_t thickness_ = 1;
  std::vector<int16_t> squares_;
};

}  // namespace

uint64_t write_distances(const VoxelWindow& window, const DistanceConfig& config,
                         MemoryBudget* budget, const std::string& path) {
  SVDAG_ASSERT(config.limit >= 1 && config.limit <= kMaxDistance);
  const LatticePoint size = window.box().max - window.box().min;
  // Roots of all squares, by square; a larger one is N.
  const int most = config.limit * config.limit;
  std::vector<float> roots;
  for (int square = 0; square <= most; ++square) roots.push_back(std::sqrt(float(square)));
  ZipWriter zip(path);
  begin_array(&zip, "distance", "<f4",
              "(" + std::to_string(size.x) + ", " + std::to_string(size.y) + ", " +
                  std::to_string(size.z) + ")");
  DistancePlanes planes(window, config, budget);
  std::vector<float> distances;
  for (int64_t x = 0; x < size.x; x += planes.thickness()) {
    const auto squares = planes.at(x);
    for (size_t done = 0; done < squares.size(); done += distances.size()) {
      distances.resize(std::min<size_t>(squares.size() - done, 1 << 16));
      for (size_t i = 0; i < distances.size(); ++i) {
        const int square = squares[done + i];
        const float root = roots[size_t(std::min(square < 0 ? -square : square, most))];
        distances[i] = square < 0 ? -root : root;
      }
      zip.put(std::as_bytes(std::span(distances)));
    }
  }
  zip.end();
  const double side = window.grid.voxel_size;
  put_placement(&zip, window.grid.corner() + Point(window.box().min) * side, side);
  begin_array(&zip, "limit", "<f8", "()");
  zip.put(double(config.limit));
  zip.end();
  zip.commit();
  return uint64_t(size.x) * uint64_t(size.y) * uint64_t(size.z);
}

}  // namespace svdag
