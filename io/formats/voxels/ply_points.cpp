#include "io/formats/voxels/ply_points.h"

#include "io/formats/output.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {

void write_ply_points(const VoxelWindow& window, const std::string& path) {
  const Point corner = window.grid.corner();
  Output out(path);
  out.put("ply\nformat binary_little_endian 1.0\ncomment centres of voxels of side " +
          format_double(window.grid.voxel_size) + ", corner " + format_double(corner.x) + " " +
          format_double(corner.y) + " " + format_double(corner.z) + ", resolution " +
          std::to_string(window.grid.resolution()) + "\nelement vertex " +
          std::to_string(window.voxels) +
          "\nproperty double x\nproperty double y\nproperty double z\n" +
          (window.colours != nullptr
               ? "property uchar red\nproperty uchar green\nproperty uchar blue\n"
               : "") +
          "end_header\n");
  const uint64_t written = for_each_voxel(window.walk, window.box(), [&](const Voxel& voxel) {
    for (int a = 0; a < 3; ++a)
      out.put(corner[a] + (double(voxel[size_t(a)]) + 0.5) * window.grid.voxel_size);
    if (window.colours == nullptr) return;
    const Colour colour = window.colours->of(voxel);
    for (const uint8_t channel : {colour.r, colour.g, colour.b}) out.put(channel);
  });
  SVDAG_ASSERT(written == window.voxels);
  out.commit();
}

}  // namespace svdag
