// The vertices of a PLY file, as points. Other elements are skipped. The comment of
// io/formats/voxels/ply_points.h gives the grid of exported voxels.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <optional>
#include <string>

#include "io/colour.h"
#include "io/formats/points/point_files.h"
#include "io/values/ply_values.h"

namespace svdag {
namespace {

// A channel of a vertex: floats are 0 .. 1, integers have the range of their type.
uint16_t channel_of(double value, PlyType type) {
  if (type == PlyType::kUint16) return value > 0 ? uint16_t(std::min(value, 65535.0)) : 0;
  return uint16_t(257 * colour_code(share_of_range(value, type)));
}

// The grid of a comment in the first lines of a file; nothing if there is none, or an impossible
// one.
std::optional<Grid> grid_of_comment(const File& file, uint64_t lines) {
  ByteStream stream(file);
  for (uint64_t i = 0; i < lines; ++i) {
    const auto line = stream.line();
    if (!line) break;
    const std::string text(line->substr(0, 256));
    Grid grid;
    Point& corner = grid.origin;
    unsigned long long resolution = 0;
    if (std::sscanf(text.c_str(),
                    "comment centres of voxels of side %lf, corner %lf %lf %lf, resolution %llu",
                    &grid.voxel_size, &corner.x, &corner.y, &corner.z, &resolution) != 5 ||
        !std::has_single_bit(resolution))
      continue;
    grid.levels = std::countr_zero(resolution);
    grid.selection = grid.levels <= kMaxLevels ? grid.whole() : VoxelBox();
    if (grid.is_valid()) return grid;
  }
  return std::nullopt;
}

class PlyCloud final : public PointCloud {
 public:
  explicit PlyCloud(const File& file) : file_(file) {
    ByteStream stream(file);
    header_ = read_ply_header(&stream);
    body_ = {stream.offset(), header_.lines + 1};
    const auto& elements = header_.elements;
    vertices_ = size_t(std::find_if(elements.begin(), elements.end(),
                                    [](const PlyElement& e) { return e.name == "vertex"; }) -
                       elements.begin());
    if (vertices_ == elements.size()) fail_input(file.path(), "has no element \"vertex\"");
    const PlyElement& vertex = elements[vertices_];
    roles_.assign(vertex.properties.size(), kSkipped);
    for (int a = 0; a < 3; ++a) {
      const std::string name(1, char('x' + a));
      const auto index = vertex.find(name);
      if (!index || vertex.properties[*index].is_list())
        fail_input(file.path(), "has vertices without a coordinate \"" + name + "\"");
      roles_[*index] = size_t(a);
    }
    grid = grid_of_comment(file, header_.lines);
    if (const auto colours = colours_of(vertex)) {
      for (size_t c = 0; c < 3; ++c) roles_[(*colours)[c]] = 3 + c;
      has_colours = true;
    }
  }

  uint64_t read(const PointSink& sink) const override {
    PointCollector out(sink);
    if (header_.format == PlyFormat::kAscii)
      read_as<PlyTextValues>(&out);
    else
      read_as<PlyBinaryValues>(&out);
    return out.finish();
  }

 private:
  static constexpr size_t kSkipped = 6;

  template <class Values>
  void read_as(PointCollector* out) const {
    Values values(file_, header_.format, body_);
    for (size_t i = 0; i < vertices_; ++i) skip_rows(values, header_.elements[i]);
    const PlyElement& vertex = header_.elements[vertices_];
    check_count(values, vertex);
    for (uint64_t row = 0; row < vertex.count; ++row) {
      Point point;
      PointColour colour{};
      for (size_t i = 0; i < vertex.properties.size(); ++i) {
        const PlyProperty& property = vertex.properties[i];
        const size_t role = roles_[i];
        if (role == kSkipped) {
          skip_property(values, property);
          continue;
        }
        const double value = values.number(property.type);
        if (role < 3)
          point[int(role)] = value;
        else
          colour[role - 3] = channel_of(value, property.type);
      }
      if (out->add(point) && has_colours) out->add_colour(colour);
    }
  }

  const File& file_;
  PlyHeader header_;
  PlyPlace body_;
  size_t vertices_ = 0;        // number of the element
  std::vector<size_t> roles_;  // of each property: 0 to 2 coordinate, 3 to 5 colour, or kSkipped
};

}  // namespace

bool has_only_points(const File& ply) {
  ByteStream stream(ply);
  return std::ranges::none_of(read_ply_header(&stream).elements, [](const PlyElement& element) {
    return (element.name == "face" || element.name == "tristrips") && element.count > 0;
  });
}

std::unique_ptr<PointCloud> open_ply_points(const File& file) {
  return std::make_unique<PlyCloud>(file);
}

}  // namespace svdag
