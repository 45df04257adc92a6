// PLY (Turk 1994): text and binary, polygons and triangle strips.
//
// The elements stand in any order. The vertices are read first; what stands before them is skipped
// and read from its place afterwards. Faces stream; rows of plain triangles in a binary file, which
// is what scans consist of, are taken straight from the window.
#include <algorithm>
#include <array>
#include <optional>

#include "io/scene/mesh_reader.h"
#include "io/scene/ply_values.h"
#include "io/scene/positions.h"
#include "io/scene/triangulate.h"

namespace svdag {
namespace {

// A binary row that is a triangle with a fixed number of bytes around its indices.
struct TriangleRow {
  size_t before = 0;  // bytes before the length of the list
  size_t bytes = 0;   // of the whole row
};

std::optional<TriangleRow> triangle_row(const PlyElement& element, size_t indices) {
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
class PlyBody {
 public:
  PlyBody(const File& file, const PlyHeader& header, const ReadOptions& options,
          const TriangleSink& sink)
      : file_(file), header_(header), triangulator_(options.budget), writer_(sink) {}

  void read(PlyPlace begin, MemoryBudget* budget) {
    const auto& elements = header_.elements;
    const auto vertices = std::find_if(elements.begin(), elements.end(),
                                       [](const PlyElement& e) { return e.name == "vertex"; });
    Values values(file_, header_.format, begin);
    if (vertices == elements.end()) values.fail("has no element \"vertex\"");
    std::vector<PlyPlace> places;
    for (auto element = elements.begin(); element != vertices; ++element) {
      places.push_back(values.place());
      skip_rows(values, *element);
    }
    read_vertices(values, *vertices, budget);
    for (size_t i = 0; i < places.size(); ++i) {
      Values earlier(file_, header_.format, places[i]);
      read_faces(earlier, elements[i]);
    }
    for (auto element = vertices + 1; element != elements.end(); ++element)
      read_faces(values, *element);
    writer_.flush();
  }

 private:
  // A count that the rest of the file cannot hold is refused before anything trusts it.
  static void check_count(Values& values, const PlyElement& element) {
    if (!element.properties.empty() && !values.may_hold(element))
      values.fail("promises " + std::to_string(element.count) + " elements \"" +
                  element.name.substr(0, 40) + "\", more than its bytes can hold");
  }

  static uint64_t list_length(Values& values, const PlyProperty& list) {
    const int64_t length = values.integer(*list.count_type);
    if (length < 0 || !values.may_hold(uint64_t(length), list.type))
      values.fail("has a list of " + std::to_string(length) + " items, which it cannot hold");
    return uint64_t(length);
  }

  static void skip_property(Values& values, const PlyProperty& property) {
    values.skip(property.type, property.is_list() ? list_length(values, property) : 1);
  }

  static void skip_rows(Values& values, const PlyElement& element) {
    if (element.properties.empty()) return;
    check_count(values, element);
    if constexpr (std::is_same_v<Values, PlyBinaryValues>) {
      if (!element.has_lists()) return values.stream().skip(element.count * element.least_bytes());
    }
    for (uint64_t row = 0; row < element.count; ++row) {
      for (const PlyProperty& property : element.properties) skip_property(values, property);
    }
  }

  void read_vertices(Values& values, const PlyElement& element, MemoryBudget* budget) {
    // For every property the coordinate that it is, or 3.
    std::vector<int> coordinate(element.properties.size(), 3);
    bool single = true;
    for (int a = 0; a < 3; ++a) {
      const std::string name(1, char('x' + a));
      const auto index = element.find(name);
      if (!index || element.properties[*index].is_list())
        values.fail("has vertices without a coordinate \"" + name + "\"");
      coordinate[*index] = a;
      const PlyType type = element.properties[*index].type;
      single = single && (type == PlyType::kFloat32 || size_of(type) < 4);
    }
    check_count(values, element);
    // A float property holds floats; text declared as a short integer may hold any number.
    if (header_.format == PlyFormat::kAscii) single = single && all_float(element, coordinate);
    positions_.emplace(budget,
                       single ? Positions::Precision::kSingle : Positions::Precision::kDouble);
    uint64_t row = 0;
    if constexpr (std::is_same_v<Values, PlyBinaryValues>) {
      if (const auto offset = plain_vertices(values, element))
        row = read_plain_vertices(values, *offset, element);
    }
    for (; row < element.count; ++row) {
      std::array<double, 4> read{};
      for (size_t i = 0; i < element.properties.size(); ++i) {
        if (coordinate[i] < 3) {
          read[size_t(coordinate[i])] = values.number(element.properties[i].type);
        } else {
          skip_property(values, element.properties[i]);
        }
      }
      positions_->add({read[0], read[1], read[2]});
    }
  }

  // Where x, y, z stand in a row that holds them as consecutive floats of this machine's order.
  static std::optional<size_t> plain_vertices(const PlyBinaryValues& values,
                                              const PlyElement& element) {
    const auto x = element.find("x");
    if (!x || element.has_lists() || values.order() != std::endian::native) return {};
    for (size_t a = 0; a < 3; ++a) {
      if (element.find(std::string(1, char('x' + a))) != *x + a ||
          element.properties[*x + a].type != PlyType::kFloat32)
        return {};
    }
    size_t offset = 0;
    for (size_t i = 0; i < *x; ++i) offset += size_of(element.properties[i].type);
    return offset;
  }

  uint64_t read_plain_vertices(PlyBinaryValues& values, size_t offset, const PlyElement& element) {
    const size_t row_bytes = element.least_bytes();
    uint64_t done = 0;
    while (done < element.count) {
      const auto bytes = values.stream().peek(row_bytes);
      const uint64_t visible = std::min(bytes.size() / row_bytes, element.count - done);
      if (visible == 0) break;
      const std::byte* p = bytes.data() + offset;
      for (uint64_t i = 0; i < visible; ++i, p += row_bytes) {
        const auto v = load<std::array<float, 3>>(p, std::endian::native);
        positions_->add({v[0], v[1], v[2]});
      }
      values.stream().skip(visible * row_bytes);
      done += visible;
    }
    return done;
  }

  static bool all_float(const PlyElement& element, const std::vector<int>& coordinate) {
    for (size_t i = 0; i < coordinate.size(); ++i) {
      if (coordinate[i] < 3 && element.properties[i].type != PlyType::kFloat32) return false;
    }
    return true;
  }

  // Rows of "face" are polygons, rows of "tristrips" are strips; everything else is skipped.
  void read_faces(Values& values, const PlyElement& element) {
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

  // As many rows as are plain triangles, at most `most`; returns their number.
  uint64_t read_plain_rows(PlyBinaryValues& values, const TriangleRow& row, uint64_t most) {
    const Positions& positions = *positions_;
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
        if (std::max({a, b, c}) >= positions.size()) break;  // the slow path has the sentence
        writer_.add(positions[a], positions[b], positions[c]);
        p += row.bytes;
      }
      values.stream().skip(taken * row.bytes);
      done += taken;
      if (taken < visible || visible == 0) break;
    }
    return done;
  }

  Point position(Values& values, int64_t index) {
    if (index < 0 || uint64_t(index) >= positions_->size())
      values.fail("has a face with vertex " + std::to_string(index) + ", but there are " +
                  std::to_string(positions_->size()) + " vertices");
    return (*positions_)[uint64_t(index)];
  }

  void read_polygon(Values& values, const PlyProperty& list) {
    for (uint64_t left = list_length(values, list); left > 0; --left)
      triangulator_.corner(position(values, values.integer(list.type)));
    triangulator_.finish(writer_);
  }

  // Each index makes a triangle with the two before it; -1 starts a new strip. A repeated index
  // is how strips are stitched to one, its triangles are no part of the surface.
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

  const File& file_;
  const PlyHeader& header_;
  Triangulator triangulator_;
  BatchWriter writer_;
  std::optional<Positions> positions_;
};

}  // namespace

void read_ply(const File& file, const ReadOptions& options, const TriangleSink& sink) {
  if (!options.wants("")) return;
  ByteStream stream(file);
  const PlyHeader header = read_ply_header(&stream);
  const PlyPlace body{stream.offset(), header.lines + 1};
  if (header.format == PlyFormat::kAscii) {
    PlyBody<PlyTextValues>(file, header, options, sink).read(body, options.budget);
  } else {
    PlyBody<PlyBinaryValues>(file, header, options, sink).read(body, options.budget);
  }
}

}  // namespace svdag
