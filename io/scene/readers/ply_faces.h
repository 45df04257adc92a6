// The faces of a PLY file: polygons and triangle strips.
//
// Written once for text and binary (ply_values.h) and for positions in memory or not (corners.h).
// Rows of plain triangles in a binary file, as in scans, are taken directly from the window.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "io/scene/mesh/corners.h"
#include "io/scene/mesh/mesh_reader.h"
#include "io/scene/polygons/triangulate.h"
#include "io/scene/readers/ply_values.h"

namespace svdag {

// A binary row that is a triangle with a fixed number of bytes around its indices.
struct TriangleRow {
  size_t before = 0;  // bytes before the length of the list
  size_t bytes = 0;   // of the whole row
};

inline std::optional<TriangleRow> triangle_row(const PlyElement& element, size_t indices) {
  const auto& properties = element.properties;
  if (size_of(*properties[indices].count_type) != 1 || size_of(properties[indices].type) != 4)
    return {};
  TriangleRow row;
  for (size_t i = 0; i < properties.size(); ++i) {
    if (i != indices && properties[i].is_list()) return {};
    if (i == indices) row.before = row.bytes;
    row.bytes += i == indices ? 1 + 3 * sizeof(uint32_t) : size_of(properties[i].type);
  }
  return row;
}

template <class Values, class Corners>
class PlyFaces {
 public:
  PlyFaces(const File& file, Corners* positions, MemoryBudget* budget, BatchWriter* writer)
      : positions_(*positions), triangulator_(budget, file.path()), writer_(*writer) {}

  // Rows of "face" are polygons, rows of "tristrips" are strips; everything else is skipped.
  void read(Values& values, const PlyElement& element) {
    const bool strips = element.name == "tristrips";
    if (element.name != "face" && !strips) return skip_rows(values, element);
    auto indices = element.find("vertex_indices");
    if (!indices) indices = element.find("vertex_index");
    if (!indices || !element.properties[*indices].is_list() ||
        !is_integer(element.properties[*indices].type)) {
      if (element.count == 0) return;
      values.fail("has faces without a list of integers \"vertex_indices\"");
    }
    check_count(values, element);
    const auto plain = strips ? std::nullopt : triangle_row(element, *indices);
    for (uint64_t row = 0; row < element.count; ++row) {
      if constexpr (std::is_same_v<Values, PlyBinaryValues>) {
        if (plain && values.order() == std::endian::native)
          row += read_plain_rows(values, *plain, element.count - row);
        if (row == element.count) break;
      }
      for (size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (i != *indices) {
          skip_property(values, property);
        } else if (strips) {
          read_strip(values, property);
        } else {
          read_polygon(values, property);
        }
      }
    }
  }

 private:
  // As many rows as are plain triangles, at most `most`; returns their number.
  uint64_t read_plain_rows(PlyBinaryValues& values, const TriangleRow& row, uint64_t most) {
    uint64_t done = 0;
    while (done < most) {
      const auto bytes = values.stream().peek(row.bytes);
      const uint64_t visible = std::min<uint64_t>(bytes.size() / row.bytes, most - done);
      uint64_t taken = 0;
      for (const std::byte* p = bytes.data() + row.before; taken < visible; ++taken) {
        if (*p != std::byte{3}) break;
        // A negative index is a huge unsigned one.
        const auto a = load<uint32_t>(p + 1, std::endian::native);
        const auto b = load<uint32_t>(p + 5, std::endian::native);
        const auto c = load<uint32_t>(p + 9, std::endian::native);
        if (std::max({a, b, c}) >= positions_.size()) break;  // the slow path reports it
        add_triangle(positions_, a, b, c, writer_);
        p += row.bytes;
      }
      values.stream().skip(taken * row.bytes);
      done += taken;
      if (taken < visible || visible == 0) break;
    }
    return done;
  }

  Point position(Values& values, int64_t index) {
    if (index < 0 || uint64_t(index) >= positions_.size())
      values.fail("has a face with vertex " + std::to_string(index) + ", but there are " +
                  std::to_string(positions_.size()) + " vertices");
    return positions_[uint64_t(index)];
  }

  void read_polygon(Values& values, const PlyProperty& list) {
    for (uint64_t left = list_length(values, list); left > 0; --left)
      triangulator_.corner(position(values, values.integer(list.type)));
    triangulator_.finish(writer_);
  }

  // Each index makes a triangle with the two before it; -1 starts a new strip. Repeated indices
  // stitch strips together; their triangles are not part of the surface.
  void read_strip(Values& values, const PlyProperty& list) {
    std::array<int64_t, 2> last{};
    std::array<Point, 2> corner{};
    uint64_t known = 0;  // indices since the start
    for (uint64_t left = list_length(values, list); left > 0; --left) {
      const int64_t index = values.integer(list.type);
      if (index == -1) {
        known = 0;
        continue;
      }
      const Point p = position(values, index);
      if (known >= 2 && index != last[0] && index != last[1] && last[0] != last[1]) {
        const size_t odd = known % 2;  // every second triangle is turned over
        writer_.add(corner[odd], corner[1 - odd], p);
      }
      last = {last[1], index};
      corner = {corner[1], p};
      ++known;
    }
  }

  Corners& positions_;
  Triangulator triangulator_;
  BatchWriter& writer_;
};

}  // namespace svdag
