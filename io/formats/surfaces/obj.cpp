// OBJ: vertices and faces of one tile after the other.
#include "io/formats/surfaces/surface_stream.h"
#include "io/units.h"

namespace svdag {

SurfaceCounts write_surface_obj(const VoxelWindow& window, const SurfaceFileConfig& config,
                                const std::string& path) {
  Output out(path);
  const bool has_colours = config.surface.colours && window.colours != nullptr;
  out.put(std::string_view("# surface of voxels, by svdag\n"));
  uint64_t first = 1;
  const SurfaceCounts counts = stream_surface(window, config, [&](const SurfaceTile& tile) {
    std::string text;
    for (const SurfaceTile::Vertex& vertex : tile.vertices) {
      const Point p = world_of(window.grid, vertex);
      text += "v " + format_double(p.x) + " " + format_double(p.y) + " " + format_double(p.z);
      if (has_colours) {
        for (const uint8_t code : {vertex.colour.r, vertex.colour.g, vertex.colour.b})
          text += " " + format_double(double(code) / 255);
      }
      text += "\n";
    }
    for (const auto& quad : tile.quads) {
      text += "f";
      for (const uint32_t i : quad) text += " " + std::to_string(first + i);
      text += "\n";
    }
    first += tile.vertices.size();
    out.put(std::string_view(text));
  });
  out.commit();
  return counts;
}

}  // namespace svdag
