// OpenMesh's own format (.om), which only OpenMesh reads.
//
// OpenMesh holds the whole mesh (98 bytes per triangle) and drops faces that its halfedges cannot
// express, so it reads nothing else for us, and its number of faces is checked against the file's.
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <array>
#include <exception>

#include "io/scene/mesh_reader.h"
#include "streaming/error.h"

namespace svdag {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;  // float positions widen without rounding
};
using Mesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

constexpr uint64_t kBytesPerElement = 128;  // halfedges, connectivity and status of one face

// "OM", mesh type, version, then the numbers of vertices, faces and edges.
struct Header {
  uint64_t vertices = 0;
  uint64_t faces = 0;
};

Header read_header(const File& file) {
  std::array<unsigned char, 16> b;
  file.read_at(0, std::as_writable_bytes(std::span(b)));
  const auto u32 = [&](size_t at) {
    return uint32_t(b[at]) | uint32_t(b[at + 1]) << 8 | uint32_t(b[at + 2]) << 16 |
           uint32_t(b[at + 3]) << 24;
  };
  if (b[0] != 'O' || b[1] != 'M') fail_input(file.path(), "is not an OpenMesh file");
  const Header header{u32(4), u32(8)};
  // A vertex takes 12 bytes or more, a face 3 or more.
  if (header.vertices > file.size() / 12 || header.faces > file.size() / 3) {
    fail_input(file.path(), "is cut off: fewer bytes than its vertices and faces need");
  }
  return header;
}

void load(const File& file, Mesh* mesh) {
  omerr().disable();  // the one error sentence is ours
  omlog().disable();
  OpenMesh::IO::Options options;
  bool read = false;
  try {
    read = OpenMesh::IO::read_mesh(*mesh, file.path(), options);
  } catch (const std::exception&) {
    read = false;
  }
  if (!read) fail_input(file.path(), "is a broken OpenMesh file");
}

}  // namespace

void read_openmesh(const File& file, const ReadOptions& options, const TriangleSink& sink) {
  if (!options.wants("")) return;
  const Header header = read_header(file);
  const auto memory = options.budget->reserve((header.vertices + header.faces) * kBytesPerElement,
                                              "OpenMesh files");
  Mesh mesh;
  load(file, &mesh);
  if (mesh.n_faces() != header.faces) {
    fail_input(file.path(), "has " + std::to_string(header.faces) +
                                " faces, of which OpenMesh could read only " +
                                std::to_string(mesh.n_faces()));
  }
  BatchWriter out(sink);
  const auto point = [&](Mesh::VertexHandle v) {
    const OpenMesh::Vec3d& p = mesh.point(v);
    return Point(p[0], p[1], p[2]);
  };
  for (const auto face : mesh.faces()) {
    auto corner = mesh.cfv_iter(face);
    const Point first = point(*corner++);
    Point before = point(*corner++);
    for (; corner.is_valid(); ++corner) {  // a fan around the first corner
      const Point p = point(*corner);
      out.add(first, before, p);
      before = p;
    }
  }
  out.flush();
}

}  // namespace svdag
