#include "verify/compare/dag_diff.h"

#include <cmath>
#include <cstring>
#include <vector>

#include "io/brick.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"

namespace svdag {
namespace {

constexpr size_t kBuffer = 1 << 20;

#pragma pack(push, 1)
struct ColouredPoint {
  float position[3];
  unsigned char colour[3];
};
#pragma pack(pop)

}  // namespace

void write_difference(DagDiff* diff, const DiffCounts& counts, const Grid& grid,
                      const std::string& path, uint64_t max_points) {
  const uint64_t points = counts.only_a + counts.only_b;
  if (points > max_points)
    throw Error(ExitCode::kUsage,
                "would get " + std::to_string(points) + " points, --write-most is " +
                    std::to_string(max_points) + ": raise --write-most",
                path);
  AtomicFile file(path);
  file.append("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points) +
              "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
              "property uchar green\nproperty uchar blue\nend_header\n");
  const double size = std::ldexp(grid.voxel_size, grid.levels - int(diff->levels()));
  const Point corner = grid.corner();
  std::vector<ColouredPoint> buffer;
  const auto flush = [&] {
    file.append(std::as_bytes(std::span(buffer)));
    buffer.clear();
  };
  diff->visit([&](const std::array<uint32_t, 3>& at, uint64_t a, uint64_t b) {
    for (unsigned bit = 0; bit < 64; ++bit) {
      if (((a ^ b) >> bit & 1) == 0) continue;
      const std::array<unsigned, 3> inner = brick_voxel(bit);
      ColouredPoint point{};
      for (int axis = 0; axis < 3; ++axis) {
        const double voxel = 4.0 * at[size_t(axis)] + inner[size_t(axis)] + 0.5;
        point.position[axis] = float(corner[axis] + size * voxel);
      }
      point.colour[(a >> bit & 1) != 0 ? 0 : 2] = 255;
      buffer.push_back(point);
    }
    if (buffer.size() >= kBuffer) flush();
    return true;
  });
  flush();
  file.commit();
}

}  // namespace svdag
