#include "io/scene/cutouts/opacity_map.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace svdag {

OpacityMap::OpacityMap(const AlphaImage& image, Wrap wrap_u, Wrap wrap_v, bool nearest,
                       double threshold)
    : u_{image.width(), wrap_u},
      v_{image.height(), wrap_v},
      nearest_(nearest),
      shift_(nearest ? 0 : 0.5) {
  const auto resized = [](int64_t columns, int64_t rows) {
    Level level{columns + kMaxBlocks - 1, columns, rows, {}};
    level.bits.resize(size_t(level.pitch * rows));
    return level;
  };
  Level level = resized(u_.size + 1, v_.size + 1);
  const int64_t next = nearest ? 0 : 1;
  for (int64_t y = 0; y < level.rows; ++y) {
    const int64_t row = wrapped(y - 1, v_.size, wrap_v);
    const int64_t row_below = wrapped(y - 1 + next, v_.size, wrap_v);
    for (int64_t x = 0; x < level.columns; ++x) {
      const int64_t column = wrapped(x - 1, u_.size, wrap_u);
      const int64_t next_column = wrapped(x - 1 + next, u_.size, wrap_u);
      const uint8_t alpha = image.at(column, row);
      const auto [least, largest] =
          std::minmax({alpha, image.at(next_column, row), image.at(column, row_below),
                       image.at(next_column, row_below)});
      level.bits[size_t(y * level.pitch + x)] =
          uint8_t((largest >= threshold ? kSome : 0) | (least >= threshold ? kAll : 0) |
                  (alpha >= threshold + kSurely ? kSample : 0));
    }
  }
  levels_.push_back(std::move(level));
  samples_.push_back(0);
  while (levels_.back().columns > 1 || levels_.back().rows > 1) {
    const Level& below = levels_.back();
    const int64_t sampled = int64_t(levels_.size()) & 1;  // near the middle of the block
    Level above = resized((below.columns + 1) / 2, (below.rows + 1) / 2);
    for (uint8_t& bits : above.bits) bits = kAll;
    for (int64_t y = 0; y < below.rows; ++y) {
      for (int64_t x = 0; x < below.columns; ++x) {
        const uint8_t bits = below.bits[size_t(y * below.pitch + x)];
        uint8_t& block = above.bits[size_t(y / 2 * above.pitch + x / 2)];
        const uint8_t sample = (x & 1) == sampled && (y & 1) == sampled ? bits & kSample : 0;
        block =
            uint8_t(((block | bits) & kSome) | (block & bits & kAll) | (block & kSample) | sample);
      }
    }
    samples_.push_back(samples_.back() + (sampled << (levels_.size() - 1)));
    levels_.push_back(std::move(above));
  }
}

// The columns that hold the wrapped cells: one interval, or two.
int OpacityMap::Axis::split(Interval cells, bool nearest, Interval out[2]) const noexcept {
  if (cells.first >= -1 && cells.last < size) return out[0] = {cells.first + 1, cells.last + 1}, 1;
  if (wrap == Wrap::kClamp) {
    out[0] = {std::clamp<int64_t>(cells.first, -1, size - 1) + 1,
              std::clamp<int64_t>(cells.last, -1, size - 1) + 1};
    return 1;
  }
  if (cells.last - cells.first >= size) return out[0] = {0, size}, 1;
  if (wrap == Wrap::kRepeat) {
    const int64_t a = cells.first - floor_div(cells.first, size) * size + 1;
    const int64_t b = cells.last - floor_div(cells.last, size) * size + 1;
    if (a <= b) return out[0] = {a, b}, 1;
    return out[0] = {a, size}, out[1] = {1, b}, 2;
  }
  // Cells ascend in even turns, and descend in odd ones. Between texels, turns begin one earlier.
  const int64_t early = nearest ? 0 : 1;
  const auto column = [&](int64_t cell, int64_t turn) {
    const int64_t at = cell + early - turn * size;
    return turn % 2 == 0 ? at + 1 - early : size - at;
  };
  const int64_t first = floor_div(cells.first + early, size);
  const int64_t last = floor_div(cells.last + early, size);
  const int64_t a = column(cells.first, first), b = column(cells.last, last);
  out[0] = {std::min(a, b), std::max(a, b)};
  if (first != last) {
    if (last % 2 == 0)
      out[0].first = 0;
    else
      out[0].last = size;
  }
  return 1;
}

// Whether the columns of the cells ascend in one turn, whose cell of column 0 is *start.
bool OpacityMap::Axis::has_one_turn(Interval cells, int64_t* start) const noexcept {
  *start = -1;
  if (cells.first >= -1 && cells.last < size) return true;
  if (wrap != Wrap::kRepeat) return false;
  *start += floor_div(cells.first, size) * size;
  return cells.last - *start <= size;
}

// The lowest level in which an area has few blocks.
int OpacityMap::level_of(Interval columns, Interval rows) const noexcept {
  const int64_t longest = std::max(columns.last - columns.first, rows.last - rows.first);
  int level = longest < kMaxBlocks ? 0 : int(std::bit_width(uint64_t(longest))) - 3;
  const auto is_long = [&](Interval of) {
    return (of.last >> level) - (of.first >> level) >= kMaxBlocks;
  };
  if (is_long(columns) || is_long(rows)) ++level;
  return level;
}

// The blocks of an area, and their opacity.
Opacity OpacityMap::look_up(Interval columns, Interval rows, Area* area) const noexcept {
  area->level = level_of(columns, rows);
  const int m = area->level;
  const Level& level = levels_[size_t(m)];
  area->x = columns.first >> m;
  area->y = rows.first >> m;
  area->columns = int((columns.last >> m) - area->x) + 1;
  area->rows = int((rows.last >> m) - area->y) + 1;
  const uint64_t used =
      area->columns == kMaxBlocks ? ~uint64_t(0) : (uint64_t(1) << 8 * area->columns) - 1;
  uint64_t some = 0, all = used & kEach * kAll;
  for (int j = 0; j < area->rows; ++j) {
    uint64_t bits;
    std::memcpy(&bits, &level.bits[size_t((area->y + j) * level.pitch + area->x)], sizeof(bits));
    area->bits[j] = bits &= used;
    some |= bits;
    all &= bits;
  }
  if ((some & kEach * kSome) == 0) return Opacity::kTransparent;
  return all == (used & kEach * kAll) ? Opacity::kOpaque : Opacity::kMixed;
}

Opacity OpacityMap::opacity(const Rectangle& cells) const noexcept {
  Interval columns[2], rows[2];
  const int n = u_.split(cells.u, nearest_, columns), m = v_.split(cells.v, nearest_, rows);
  Area area;
  const Opacity first = look_up(columns[0], rows[0], &area);
  for (int k = 1; k < n * m; ++k) {
    if (look_up(columns[k % n], rows[k / n], &area) != first) return Opacity::kMixed;
  }
  return first;
}

Opacity OpacityMap::opacity(const Rectangle& cells, Blocks* blocks) const noexcept {
  blocks->columns = 0;
  int64_t u, v;  // the cells of column 0 and of row 0
  if (!u_.has_one_turn(cells.u, &u) || !v_.has_one_turn(cells.v, &v)) return opacity(cells);
  Area area;
  const Opacity opacity =
      look_up({cells.u.first - u, cells.u.last - u}, {cells.v.first - v, cells.v.last - v}, &area);
  if (opacity != Opacity::kMixed) return opacity;
  const double half = 0.5 * double(int64_t(1) << area.level);
  blocks->columns = area.columns;
  blocks->rows = area.rows;
  std::copy(area.bits, area.bits + area.rows, blocks->bits);
  blocks->size = 2 * half;
  blocks->u = double((area.x << area.level) + u) + half + shift_;
  blocks->v = double((area.y << area.level) + v) + half + shift_;
  blocks->sample = double(samples_[size_t(area.level)]) + 0.5 - half - shift_;
  return opacity;
}

}  // namespace svdag
