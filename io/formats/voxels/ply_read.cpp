#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <sstream>

#include "io/formats/voxels/ply_points.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"

namespace svdag {
namespace {

struct Type {
  const char *name, *other_name;
  size_t bytes;
  char kind;  // 'i' signed, 'u' unsigned, 'f' float
};
constexpr Type kTypes[] = {{"char", "int8", 1, 'i'},     {"uchar", "uint8", 1, 'u'},
                           {"short", "int16", 2, 'i'},   {"ushort", "uint16", 2, 'u'},
                           {"int", "int32", 4, 'i'},     {"uint", "uint32", 4, 'u'},
                           {"float", "float32", 4, 'f'}, {"double", "float64", 8, 'f'}};

struct Property {
  std::string name;
  const Type* type;
  size_t offset;  // in a binary row
};

struct PointHeader {
  bool is_text = false, is_big_endian = false;
  uint64_t points = 0;
  std::vector<Property> properties;
  size_t row_bytes = 0;
  uint64_t begin = 0;                      // offset of the points
  std::optional<GridPlacement> placement;  // of the comment

  std::optional<size_t> find(const std::string& name) const {
    for (size_t i = 0; i < properties.size(); ++i)
      if (properties[i].name == name) return i;
    return std::nullopt;
  }
};

PointHeader read_header(const File& file) {
  PointHeader header;
  ByteStream stream(file);
  const auto fail = [&](const char* what) { fail_input(file.path(), what, stream.offset()); };
  std::string element;
  size_t elements = 0;
  for (;;) {
    const auto line = stream.line(1 << 16);
    if (!line) fail("is not a .ply of points: its header does not end");
    std::istringstream words{std::string(*line)};
    std::string word, type, name;
    words >> word;
    if (word == "end_header") break;
    if (word == "format") {
      words >> type;
      header.is_text = type == "ascii";
      header.is_big_endian = type == "binary_big_endian";
    } else if (word == "element") {
      uint64_t count = 0;
      words >> element >> count;
      if (words.fail()) fail("has an element without a count");
      if (element == "face" && count > 0)
        fail_input(file.path(), "is a mesh: bake it with svdag build");
      if (element == "vertex" && elements > 0) fail("has elements before its points");
      if (element == "vertex") header.points = count;
      ++elements;
    } else if (word == "property" && element == "vertex") {
      words >> type >> name;
      const Type* known = nullptr;
      for (const Type& t : kTypes)
        if (type == t.name || type == t.other_name) known = &t;
      if (known == nullptr) fail("has a property of points that is not a number");
      header.properties.push_back({name, known, header.row_bytes});
      header.row_bytes += known->bytes;
    } else if (word == "comment") {
      const std::string text(*line);
      double side = 0, x = 0, y = 0, z = 0;
      unsigned long long resolution = 0;
      if (std::sscanf(text.c_str(),
                      "comment centres of voxels of side %lf, corner %lf %lf %lf, resolution %llu",
                      &side, &x, &y, &z, &resolution) == 5 &&
          side > 0 && resolution <= uint64_t(1) << kMaxLevels)
        header.placement = GridPlacement{{x, y, z}, side, resolution};
    }
  }
  header.begin = stream.offset();
  for (const char* const axis : {"x", "y", "z"})
    if (!header.find(axis)) fail("has points without x, y and z");
  return header;
}

// The value of a binary number.
double value_of(const std::byte* at, const Type& type, bool is_big_endian) {
  std::array<std::byte, 8> bytes{};
  for (size_t i = 0; i < type.bytes; ++i) bytes[i] = at[is_big_endian ? type.bytes - 1 - i : i];
  const auto bits = std::bit_cast<uint64_t>(bytes);
  if (type.kind == 'f' && type.bytes == 4) return double(std::bit_cast<float>(uint32_t(bits)));
  if (type.kind == 'f') return std::bit_cast<double>(bits);
  const unsigned unused = 64 - 8 * unsigned(type.bytes);
  return type.kind == 'u' ? double(bits) : double(int64_t(bits << unused) >> unused);
}

// Calls visit(values of a point's properties) for all points.
template <class Visit>
void for_each_point(const File& file, const PointHeader& header, const Visit& visit) {
  ByteStream stream(file, header.begin);
  std::vector<double> values(header.properties.size());
  for (uint64_t point = 0; point < header.points; ++point) {
    if (point % 65536 == 0) check_interrupt();
    if (header.is_text) {
      const uint64_t offset = stream.offset();
      const auto line = stream.line();
      if (!line) fail_input(file.path(), "has fewer points than its header says", offset);
      const char *at = line->data(), *const end = at + line->size();
      for (double& value : values) {
        while (at != end && (*at == ' ' || *at == '\t')) ++at;
        const auto read = std::from_chars(at, end, value);
        if (read.ec != std::errc())
          fail_input(file.path(), "has a line without its numbers", offset);
        at = read.ptr;
      }
    } else {
      const auto bytes = stream.peek(header.row_bytes);
      if (bytes.size() < header.row_bytes)
        fail_input(file.path(), "has fewer points than its header says", stream.offset());
      for (size_t i = 0; i < values.size(); ++i) {
        const Property& property = header.properties[i];
        values[i] = value_of(bytes.data() + property.offset, *property.type, header.is_big_endian);
      }
      stream.skip(header.row_bytes);
    }
    visit(values);
  }
}

// The properties of a colour; none if one is missing.
std::optional<std::array<size_t, 3>> colours_of(const PointHeader& header) {
  for (const std::string before : {"", "diffuse_"}) {
    const auto r = header.find(before + "red"), g = header.find(before + "green"),
               b = header.find(before + "blue");
    if (r && g && b) return std::array{*r, *g, *b};
  }
  return std::nullopt;
}

uint8_t code_of(double value, const Type& type) {
  return colour_code(type.kind == 'f' ? value : value / (type.bytes == 1 ? 255 : 65535));
}

}  // namespace

GridPlacement read_ply_points(const File& file, const VoxelSink& sink, bool with_colours,
                              int levels) {
  const PointHeader header = read_header(file);
  const std::array<size_t, 3> axes{*header.find("x"), *header.find("y"), *header.find("z")};
  const auto point_of = [&](const std::vector<double>& values) {
    const Point point(values[axes[0]], values[axes[1]], values[axes[2]]);
    for (int a = 0; a < 3; ++a)
      if (!std::isfinite(point[a])) fail_input(file.path(), "has a point that is not finite");
    return point;
  };
  GridPlacement place;
  if (header.placement) {
    place = *header.placement;
  } else {
    if (levels == 0)
      fail_usage(file.path() + ": its points have no grid: give the voxels per axis with -r");
    Box box;
    for_each_point(file, header, [&](const auto& values) { box.add(point_of(values)); });
    if (header.points == 0) fail_input(file.path(), "has no points");
    place.resolution = uint64_t(1) << levels;
    place.corner = box.min;
    const Point size = box.max - box.min;
    place.voxel_size = std::max({size.x, size.y, size.z}) / double(place.resolution);
    if (place.voxel_size == 0) place.voxel_size = 1;
  }
  const auto colours = with_colours ? colours_of(header) : std::nullopt;
  const bool is_cube = !header.placement;  // its largest faces belong to the last voxels
  VoxelBatch batch(sink);
  for_each_point(file, header, [&](const auto& values) {
    const Point point = point_of(values);
    Voxel voxel;
    for (int a = 0; a < 3; ++a) {
      double at = std::floor((point[a] - place.corner[a]) / place.voxel_size);
      if (is_cube) at = std::min(at, double(place.resolution - 1));
      if (!(at >= 0 && at < 0x1p20))
        fail_input(file.path(), "has a point outside of the 1M^3 voxels of its grid");
      voxel[size_t(a)] = uint32_t(at);
    }
    batch.add(voxel);
    if (!colours) return;
    const auto code = [&](size_t c) {
      const size_t property = (*colours)[c];
      return code_of(values[property], *header.properties[property].type);
    };
    batch.add_colour({code(0), code(1), code(2)});
  });
  batch.flush();
  return place;
}

}  // namespace svdag
