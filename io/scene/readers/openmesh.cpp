// Reads .om, OpenMesh's own format, with OpenMesh.
//
// OpenMesh holds the whole mesh (98 bytes per triangle) and drops faces that its halfedges cannot
// express, so it reads no other format, and its number of faces is checked against the file's.
// Broken files end it in an assertion, so it always runs in a process of its own; under --sandbox,
// one that can only compute.
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <array>
#include <exception>
#include <sstream>
#include <vector>

#include "io/scene/readers/decoded_mesh.h"
#include "streaming/error.h"

namespace svdag {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;  // float positions widen without rounding
};
using Mesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

constexpr uint64_t kBytesPerElement = 128;  // halfedges, connectivity and status of one face

// "OM", mesh type, version, then the numbers of vertices, faces and edges.
struct OmHeader {
  uint64_t vertices = 0;
  uint64_t faces = 0;
};

OmHeader read_header(const File& file) {
  std::array<unsigned char, 16> b;
  file.read_at(0, std::as_writable_bytes(std::span(b)));
  const auto u32 = [&](size_t at) {
    return uint32_t(b[at]) | uint32_t(b[at + 1]) << 8 | uint32_t(b[at + 2]) << 16 |
           uint32_t(b[at + 3]) << 24;
  };
  if (b[0] != 'O' || b[1] != 'M') fail_input(file.path(), "is not an OpenMesh file");
  const OmHeader header{u32(4), u32(8)};
  // A vertex takes 12 bytes or more, a face 3 or more, an edge one or more: OpenMesh allocates
  // memory for the counts given here.
  if (header.vertices > file.size() / 12 || header.faces > file.size() / 3 ||
      u32(12) > file.size()) {
    fail_input(file.path(), "is cut off: fewer bytes than its vertices, faces and edges need");
  }
  return header;
}

// From memory, so that a limited child needs no file.
void load(const File& file, std::span<const std::byte> bytes, Mesh* mesh) {
  omerr().disable();  // the one error sentence is ours
  omlog().disable();
  OpenMesh::IO::Options options;
  std::istringstream in(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  bool read = false;
  try {
    read = OpenMesh::IO::read_mesh(*mesh, in, ".om", options);
  } catch (const std::exception&) {
    read = false;
  }
  if (!read) fail_input(file.path(), "is a broken OpenMesh file");
}

// Fills `corners` with the corners of a face. OpenMesh takes the links of halfedges from the file
// as they are: they may lead nowhere, or round and round beside where they began. `left`: corners
// that the mesh can still have, one per halfedge.
void find_corners(const File& file, const Mesh& mesh, Mesh::FaceHandle face, uint64_t* left,
                  std::vector<uint32_t>* corners) {
  corners->clear();
  const auto first = mesh.halfedge_handle(face);
  auto halfedge = first;
  do {
    if (!mesh.is_valid_handle(halfedge) || (*left)-- == 0)
      fail_input(file.path(), "is a broken OpenMesh file");
    const auto vertex = mesh.to_vertex_handle(halfedge);
    if (!mesh.is_valid_handle(vertex)) fail_input(file.path(), "is a broken OpenMesh file");
    corners->push_back(uint32_t(vertex.idx()));
    halfedge = mesh.next_halfedge_handle(halfedge);
  } while (halfedge != first);
}

void decode_om(const File& file, std::span<const std::byte> bytes, const OmHeader& header,
               DecoderOutput* decoder) {
  Mesh mesh;
  load(file, bytes, &mesh);
  if (mesh.n_faces() != header.faces) {
    fail_input(file.path(), "has " + std::to_string(header.faces) +
                                " faces, but OpenMesh could read only " +
                                std::to_string(mesh.n_faces()));
  }
  DecodedMeshSender out(decoder);
  for (const auto vertex : mesh.vertices()) {
    const OpenMesh::Vec3d& p = mesh.point(vertex);
    out.vertex({p[0], p[1], p[2]});
  }
  uint64_t left = mesh.n_halfedges();
  std::vector<uint32_t> corners;
  for (const auto face : mesh.faces()) {
    find_corners(file, mesh, face, &left, &corners);
    out.polygon(corners);
  }
  out.finish();
}

}  // namespace

LeftOut read_openmesh(const File& file, const ReadOptions& options, MeshWriter* out) {
  if (!options.wants("")) return {};
  const OmHeader header = read_header(file);
  const auto memory = options.budget->reserve(
      2 * file.size() + (header.vertices + header.faces) * kBytesPerElement, "OpenMesh files");
  std::vector<std::byte> bytes(size_t(file.size()));
  file.read_at(0, bytes);
  DecoderLimits limits = decoder_limits(bytes.size(), *options.budget);
  limits.memory += memory.bytes();  // the child takes it
  DecodedMeshReceiver receiver(out);
  receiver.begin(header.vertices);
  run_decoder(
      limits, file.path(), options.sandbox,
      [&](DecoderOutput& decoder) { decode_om(file, bytes, header, &decoder); },
      [&](const DecoderMessage& message) { receiver.receive(message); });
  return {};
}

}  // namespace svdag
