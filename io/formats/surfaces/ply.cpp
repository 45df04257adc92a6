// PLY: quads. A comment fills the header up to its largest size.
#include "io/formats/surfaces/surface_stream.h"
#include "io/units.h"

namespace svdag {
namespace {

std::string header_of(const VoxelWindow& window, const SurfaceCounts& counts, bool has_colours) {
  const std::string vertices = std::to_string(counts.vertices);
  const std::string quads = std::to_string(counts.quads);
  const std::string fill(40 - vertices.size() - quads.size(), ' ');
  return "ply\nformat binary_little_endian 1.0\ncomment surface of voxels of side " +
         format_double(window.grid.voxel_size) + fill + "\nelement vertex " + vertices +
         "\nproperty double x\nproperty double y\nproperty double z\n" +
         (has_colours ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "") +
         "element face " + quads + "\nproperty list uchar uint vertex_indices\nend_header\n";
}

}  // namespace

SurfaceCounts write_surface_ply(const VoxelWindow& window, const SurfaceFileConfig& config,
                                const std::string& path) {
  Output out(path);
  LaterBytes faces(path);
  const bool has_colours = config.surface.colours && window.colours != nullptr;
  out.put(std::string_view(header_of(window, {}, has_colours)));
  uint64_t first = 0;
  const SurfaceCounts counts = stream_surface(window, config, [&](const SurfaceTile& tile) {
    for (const SurfaceTile::Vertex& vertex : tile.vertices) {
      const Point p = world_of(window.grid, vertex);
      for (int a = 0; a < 3; ++a) out.put(p[a]);
      if (!has_colours) continue;
      for (const uint8_t code : {vertex.colour.r, vertex.colour.g, vertex.colour.b}) out.put(code);
    }
    for (const auto& quad : tile.quads) {
      faces.put(uint8_t(4));
      for (const uint32_t i : quad) faces.put(uint32_t(first + i));
    }
    first += tile.vertices.size();
    if (first > UINT32_MAX) fail_too_large(path, "a PLY has less than 2^32 vertices");
  });
  faces.append_to(&out);
  out.patch(0, std::string_view(header_of(window, counts, has_colours)));
  out.commit();
  return counts;
}

}  // namespace svdag
