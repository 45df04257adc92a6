// STL: two facets a quad, in floats.
#include "io/formats/surfaces/surface_stream.h"

namespace svdag {

namespace {

// Of a quad whose sides are along two axes.
std::array<float, 3> normal_of(const SurfaceTile& tile, const std::array<uint32_t, 4>& quad) {
  const auto side = [&](size_t k, size_t a) {
    return tile.vertices[quad[k]].at[a] - tile.vertices[quad[k - 1]].at[a];
  };
  std::array<float, 3> normal;
  for (size_t a = 0; a < 3; ++a) {
    const size_t b = (a + 1) % 3, c = (a + 2) % 3;
    const int64_t area = int64_t(side(1, b)) * side(2, c) - int64_t(side(1, c)) * side(2, b);
    normal[a] = float((area > 0) - (area < 0));
  }
  return normal;
}

}  // namespace

SurfaceCounts write_surface_stl(const VoxelWindow& window, const SurfaceFileConfig& config,
                                const std::string& path) {
  constexpr uint64_t kCountAt = 80;
  Output out(path);
  out.put(std::string_view(std::string(kCountAt + sizeof(uint32_t), '\0')));
  SurfaceFileConfig plain = config;
  plain.surface.colours = false;
  uint64_t facets = 0;
  const SurfaceCounts counts = stream_surface(window, plain, [&](const SurfaceTile& tile) {
    for (size_t q = 0; q < tile.quads.size(); ++q) {
      const std::array<float, 3> normal = normal_of(tile, tile.quads[q]);
      for (const auto& corners : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
        for (const float n : normal) out.put(n);
        for (const int k : corners) {
          const Point p = world_of(window.grid, tile.vertices[tile.quads[q][size_t(k)]]);
          for (int a = 0; a < 3; ++a) out.put(float(p[a]));
        }
        out.put(uint16_t(0));
      }
    }
    facets += 2 * tile.quads.size();
    if (facets > UINT32_MAX) fail_too_large(path, "an STL has less than 2^32 triangles");
  });
  out.patch(kCountAt, uint32_t(facets));
  out.commit();
  return counts;
}

}  // namespace svdag
