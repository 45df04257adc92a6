// The faces of a PLY file: polygons and triangle strips.
//
// Written once for text and binary (ply_values.h).
// Rows of plain triangles in a binary file, as in scans, are taken directly from the window.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "io/scene/polygons/mesh_writer.h"
#include "io/values/ply_values.h"

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

template <class Values>
class PlyFaces {
 public:
  // `coloured`: their colours are wanted, which are rounded to 8 bits.
  PlyFaces(bool coloured, MeshWriter* out, LeftOut* left_out)
      : is_coloured_(coloured), out_(*out), left_out_(*left_out) {}

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
    const auto colours = is_coloured_ && !strips ? colours_of(element) : std::nullopt;
    const auto plain = strips || colours ? std::nullopt : triangle_row(element, *indices);
    std::array<double, 3> colour{};
    for (uint64_t row = 0; row < element.count; ++row) {
      if constexpr (std::is_same_v<Values, PlyBinaryValues>) {
        if (plain && values.order() == std::endian::native)
          row += read_plain_rows(values, *plain, element.count - row);
        if (row == element.count) break;
      }
      for (size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (i == *indices) {
          strips ? read_strip(values, property) : read_corners(values, property);
        } else if (const size_t channel = channel_of(i, colours); channel < 3) {
          colour[channel] = share_of_range(values.number(property.type), property.type);
        } else {
          skip_property(values, property);
        }
      }
      if (colours) set_colour(colour);
      if (!strips) out_.end_polygon();
    }
  }

 private:
  // Reads rows while they are plain triangles, at most `max_rows`; returns their number.
  uint64_t read_plain_rows(PlyBinaryValues& values, const TriangleRow& row, uint64_t max_rows) {
    uint64_t done = 0;
    while (done < max_rows) {
      const auto bytes = values.stream().peek(row.bytes);
      const uint64_t visible = std::min<uint64_t>(bytes.size() / row.bytes, max_rows - done);
      uint64_t taken = 0;
      for (const std::byte* p = bytes.data() + row.before; taken < visible; ++taken) {
        if (*p != std::byte{3}) break;
        // A negative index is a huge unsigned one.
        const auto a = load<uint32_t>(p + 1, std::endian::native);
        const auto b = load<uint32_t>(p + 5, std::endian::native);
        const auto c = load<uint32_t>(p + 9, std::endian::native);
        if (std::max({a, b, c}) >= out_.vertices()) break;  // the slow path reports it
        out_.triangle(a, b, c);
        p += row.bytes;
      }
      values.stream().skip(taken * row.bytes);
      done += taken;
      if (taken < visible || visible == 0) break;
    }
    return done;
  }

  uint64_t vertex(Values& values, int64_t index) {
    if (index < 0 || uint64_t(index) >= out_.vertices())
      values.fail("has a face with vertex " + std::to_string(index) + ", but there are " +
                  std::to_string(out_.vertices()) + " vertices");
    return uint64_t(index);
  }

  // 3: the property is not of the colour.
  static size_t channel_of(size_t property, const std::optional<std::array<size_t, 3>>& colours) {
    return colours ? size_t(std::ranges::find(*colours, property) - colours->begin()) : 3;
  }

  // Of the polygon whose corners were passed on.
  void set_colour(const std::array<double, 3>& c) {
    const Colour colour{colour_code(c[0]), colour_code(c[1]), colour_code(c[2])};
    left_out_.add(Omission::kBrightColours, std::ranges::max(c) > 1);
    if (colour != colour_) out_.material("", colour);
    colour_ = colour;
  }

  void read_corners(Values& values, const PlyProperty& list) {
    for (uint64_t left = list_length(values, list); left > 0; --left)
      out_.corner(vertex(values, values.integer(list.type)));
  }

  // Each index makes a triangle with the two before it; -1 starts a new strip. Repeated indices
  // stitch strips together; their triangles are not part of the surface.
  void read_strip(Values& values, const PlyProperty& list) {
    std::array<uint64_t, 2> last{};
    uint64_t known = 0;  // indices since the start
    for (uint64_t left = list_length(values, list); left > 0; --left) {
      const int64_t index = values.integer(list.type);
      if (index == -1) {
        known = 0;
        continue;
      }
      const uint64_t v = vertex(values, index);
      if (known >= 2 && v != last[0] && v != last[1] && last[0] != last[1]) {
        const size_t odd = known % 2;  // every second triangle is turned over
        out_.triangle(last[odd], last[1 - odd], v);
      }
      last = {last[1], v};
      ++known;
    }
  }

  bool is_coloured_;
  MeshWriter& out_;
  LeftOut& left_out_;
  std::optional<Colour> colour_;  // that out_ has
};

}  // namespace svdag
