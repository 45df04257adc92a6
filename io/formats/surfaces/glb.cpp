// GLB: a node with one mesh. The head, of a fixed size, is written when the counts are known.
#include <algorithm>

#include "io/colour.h"
#include "io/formats/surfaces/surface_stream.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint64_t kHeadBytes = 2048;  // of the file's head and the JSON's chunk
constexpr uint64_t kPlaceBytes = 12, kColourBytes = 8;

std::array<uint16_t, 4> linear16(const Colour& colour) {
  return {light16_of_code(colour.r), light16_of_code(colour.g), light16_of_code(colour.b),
          UINT16_MAX};
}

std::string numbers(const auto& values) {
  std::string text;
  for (int a = 0; a < 3; ++a)
    text += (a == 0 ? "[" : ",") + format_double(double(values[size_t(a)]));
  return text + "]";
}

struct GlbHead {
  const Grid& grid;
  uint64_t vertices, indices;
  bool has_colours;
  std::array<int32_t, 3> low, high;

  uint64_t vertex_bytes() const { return kPlaceBytes + (has_colours ? kColourBytes : 0); }
  uint64_t binary_bytes() const { return vertices * vertex_bytes() + indices * sizeof(uint32_t); }
  std::string json() const;
  std::string bytes() const;
};

std::string GlbHead::json() const {
  const std::string n = std::to_string(vertices), m = std::to_string(indices);
  const std::string stride = std::to_string(vertex_bytes());
  const std::string of_vertices = std::to_string(vertices * vertex_bytes());
  const double size = grid.voxel_size;
  const Point corner = grid.corner();
  std::string text = R"({"asset":{"version":"2.0","generator":"svdag"},"scene":0,"scenes":[{)";
  if (indices == 0) return text + "}]}";
  text += R"("nodes":[0]}],"nodes":[{"mesh":0,"scale":)" + numbers(std::array{size, size, size}) +
          R"(,"translation":)" + numbers(std::array{corner.x, corner.y, corner.z}) +
          R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0)" +
          (has_colours ? R"(,"COLOR_0":1)" : "") + R"(},"indices":)" + (has_colours ? "2" : "1") +
          R"(,"material":0}]}],"materials":[{"pbrMetallicRoughness":{"metallicFactor":0}}],)" +
          R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" + n +
          R"(,"min":)" + numbers(low) + R"(,"max":)" + numbers(high) + "}";
  if (has_colours)
    text += R"(,{"bufferView":0,"byteOffset":12,"componentType":5123,"normalized":true,)"
            R"("type":"VEC4","count":)" +
            n + "}";
  text += R"(,{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" + m +
          R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + of_vertices + R"(,"byteStride":)" +
          stride + R"(,"target":34962},{"buffer":0,"byteOffset":)" + of_vertices +
          R"(,"byteLength":)" + std::to_string(indices * sizeof(uint32_t)) +
          R"(,"target":34963}],"buffers":[{"byteLength":)" + std::to_string(binary_bytes()) + "}]}";
  return text;
}

std::string GlbHead::bytes() const {
  const auto u32 = [](uint64_t value) {
    const auto v = uint32_t(value);
    return std::string(reinterpret_cast<const char*>(&v), sizeof v);
  };
  const uint64_t json_bytes = kHeadBytes - 28;  // without three heads, of 12, 8 and 8 bytes
  std::string text = json();
  SVDAG_ASSERT(text.size() <= json_bytes);
  text.resize(size_t(json_bytes), ' ');
  return "glTF" + u32(2) + u32(kHeadBytes + binary_bytes()) + u32(json_bytes) + "JSON" + text +
         u32(binary_bytes()) + std::string("BIN\0", 4);
}

}  // namespace

SurfaceCounts write_surface_glb(const VoxelWindow& window, const SurfaceFileConfig& config,
                                const std::string& path) {
  Output out(path);
  LaterBytes indices(path);
  GlbHead head{window.grid, 0, 0, config.surface.colours && window.colours != nullptr, {}, {}};
  head.low.fill(INT32_MAX);
  head.high.fill(INT32_MIN);
  out.put(std::string_view(std::string(kHeadBytes, ' ')));
  const SurfaceCounts counts = stream_surface(window, config, [&](const SurfaceTile& tile) {
    for (const auto& quad : tile.quads) {
      for (const size_t k : {0, 1, 2, 0, 2, 3}) indices.put(uint32_t(head.vertices + quad[k]));
    }
    for (const SurfaceTile::Vertex& vertex : tile.vertices) {
      for (size_t a = 0; a < 3; ++a) {
        head.low[a] = std::min(head.low[a], vertex.at[a]);
        head.high[a] = std::max(head.high[a], vertex.at[a]);
        out.put(float(vertex.at[a]));
      }
      if (!head.has_colours) continue;
      for (const uint16_t channel : linear16(vertex.colour)) out.put(channel);
    }
    head.vertices += tile.vertices.size();
    head.indices += 6 * tile.quads.size();
    if (kHeadBytes + head.binary_bytes() > UINT32_MAX)
      fail_too_large(path, "a GLB has less than 4 GiB");
  });
  indices.append_to(&out);
  out.patch(0, std::string_view(head.bytes()));
  out.commit();
  return counts;
}

}  // namespace svdag
