#include "tests/scenes/ply_writer.h"

#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "tests/scenes/large_writes.h"
#include "tests/scenes/numbers.h"
#include "tests/scenes/permutation.h"

namespace svdag::scenes {
namespace {

std::string header(const Mesh& mesh, bool double_precision) {
  const std::string type = double_precision ? "double" : "float";
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  text += "element vertex " + std::to_string(mesh.vertices()) + "\n";
  for (const char* axis : {"x", "y", "z"}) text += "property " + type + " " + axis + "\n";
  text += "element face " + std::to_string(mesh.faces()) + "\n";
  return text + "property list uchar uint vertex_indices\nend_header\n";
}

struct Rotation {
  double sine, cosine;
  Point operator()(const Point& p) const {
    return {p.x * cosine + p.z * sine, p.y, p.z * cosine - p.x * sine};
  }
};

}  // namespace

Point placed(const Mesh& mesh, const PlyOptions& options, uint64_t i) {
  const Rotation yaw{sin_turns(options.yaw / 360), cos_turns(options.yaw / 360)};
  return quantised(yaw(mesh.vertex(i)));
}

void write_ply(const Mesh& mesh, const PlyOptions& options, const std::string& path) {
  if (mesh.vertices() > uint64_t(1) << 32)
    fail_usage("--triangles: the scene would have " + std::to_string(mesh.vertices()) +
               " vertices, more than a PLY file can number (2^32)");
  AtomicFile file(path);
  file.append(header(mesh, options.double_precision));
  LargeWrites out(&file);
  const Permutation vertex_order(mesh.vertices(), hash(options.seed, 1));
  const Permutation face_order(mesh.faces(), hash(options.seed, 2));

  for (uint64_t i = 0; i < mesh.vertices(); ++i) {
    const Point p = placed(mesh, options, options.shuffle ? vertex_order.forward(i) : i);
    for (int a = 0; a < 3; ++a) {
      // + 0.0 turns -0 into 0.
      if (options.double_precision) {
        out.put(p[a] + 0.0);
      } else {
        out.put(float(p[a] + 0.0));
      }
    }
  }
  for (uint64_t i = 0; i < mesh.faces(); ++i) {
    const Face face = mesh.face(options.shuffle ? face_order.forward(i) : i);
    out.put(uint8_t(3));
    for (const uint64_t v : face) out.put(uint32_t(options.shuffle ? vertex_order.inverse(v) : v));
  }
  out.flush();
  file.commit();
}

}  // namespace svdag::scenes
