// PLY (Turk 1994): text and binary, polygons and triangle strips.
//
// Elements may come in any order. The vertices are read first; elements before them are skipped and
// read afterwards. Faces are streamed (ply_faces.h).
#include <algorithm>
#include <array>
#include <optional>

#include "io/scene/readers/ply_faces.h"
#include "io/values/ply_values.h"

namespace svdag {
namespace {

template <class Values>
class PlyBody {
 public:
  // `coloured`: the colours of vertices are wanted, or if they have none those of faces.
  PlyBody(const File& file, const PlyHeader& header, bool coloured, MeshWriter* out,
          LeftOut* left_out)
      : file_(file), header_(header), is_coloured_(coloured), out_(*out), left_out_(*left_out) {}

  void read(PlyPlace begin) {
    const auto& elements = header_.elements;
    const auto vertices = std::find_if(elements.begin(), elements.end(),
                                       [](const PlyElement& e) { return e.name == "vertex"; });
    {
      Values values(file_, header_.format, begin);
      if (vertices == elements.end()) values.fail("has no element \"vertex\"");
      for (auto element = elements.begin(); element != vertices; ++element) {
        places_.push_back(values.place());
        skip_rows(values, *element);
      }
      read_vertices(values, *vertices);
      places_.push_back(values.place());
    }
    read_faces();
  }

 private:
  // All elements except the vertices.
  void read_faces() {
    PlyFaces<Values> faces(is_coloured_ && !has_vertex_colours_, &out_, &left_out_);
    const auto& elements = header_.elements;
    const size_t earlier = places_.size() - 1;
    for (size_t i = 0; i < earlier; ++i) {
      Values values(file_, header_.format, places_[i]);
      faces.read(values, elements[i]);
    }
    Values values(file_, header_.format, places_.back());
    for (size_t i = earlier + 1; i < elements.size(); ++i) faces.read(values, elements[i]);
  }

  void read_vertices(Values& values, const PlyElement& element) {
    // For every property the coordinate that it is; 3: none; 4 to 6: red, green and blue.
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
    const auto precision = single ? MeshWriter::Precision::kSingle : MeshWriter::Precision::kDouble;
    const auto colours = is_coloured_ ? colours_of(element) : std::nullopt;
    if (colours) {
      for (size_t c = 0; c < 3; ++c) coordinate[(*colours)[c]] = int(4 + c);
      has_vertex_colours_ = true;
      out_.begin_coloured(precision, element.count);
      return read_coloured(values, element, coordinate);
    }
    out_.begin(precision, element.count);
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
      out_.vertex({read[0], read[1], read[2]});
    }
  }

  void read_coloured(Values& values, const PlyElement& element,
                     const std::vector<int>& coordinate) {
    for (uint64_t row = 0; row < element.count; ++row) {
      std::array<double, 7> read{};
      VertexColour colour{};
      bool is_bright = false;
      for (size_t i = 0; i < element.properties.size(); ++i) {
        const PlyType type = element.properties[i].type;
        const size_t to = size_t(coordinate[i]);
        if (to == 3) {
          skip_property(values, element.properties[i]);
          continue;
        }
        read[to] = values.number(type);
        if (to <= 3) continue;
        const double value = share_of_range(read[to], type);
        colour[to - 4] = light16_of_srgb(value);
        is_bright |= value > 1;
      }
      left_out_.add(Omission::kBrightColours, is_bright);
      out_.vertex({read[0], read[1], read[2]}, colour);
    }
  }

  // Offset of x, y, z in a row that holds them as consecutive floats in native byte order.
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
        out_.vertex({v[0], v[1], v[2]});
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

  const File& file_;
  const PlyHeader& header_;
  bool is_coloured_, has_vertex_colours_ = false;
  MeshWriter& out_;
  LeftOut& left_out_;
  std::vector<PlyPlace> places_;  // of the elements before the vertices, and of what follows those
};

}  // namespace

LeftOut read_ply(const File& file, const ReadOptions& options, MeshWriter* out) {
  if (!options.wants("")) return {};
  ByteStream stream(file);
  const PlyHeader header = read_ply_header(&stream);
  const PlyPlace body{stream.offset(), header.lines + 1};
  const bool coloured = options.paints != nullptr;
  LeftOut left_out;
  if (header.format == PlyFormat::kAscii) {
    PlyBody<PlyTextValues>(file, header, coloured, out, &left_out).read(body);
  } else {
    PlyBody<PlyBinaryValues>(file, header, coloured, out, &left_out).read(body);
  }
  left_out.add(Omission::kHeaderLines, header.unknown_lines);
  for (const PlyElement& element : header.elements) {
    if (element.name == "edge" && element.count > 0) left_out.add(Omission::kPointsOrLines);
  }
  return left_out;
}

}  // namespace svdag
