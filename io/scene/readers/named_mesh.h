// Meshes with names and materials on their way from a decoder in a limited child to a MeshWriter:
// the protocol of FBX, 3MF, COLLADA and 3DS.
//
// Of each mesh: a NamedMeshHead, the names of its nodes from the root on, its vertices; then for
// each material its name and colour, and the polygons that have it. If colours of points are
// wanted, a NamedPaint may follow the material, after the image that it names first.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "io/scene/readers/decoded_mesh.h"

namespace svdag {

struct NamedMeshHead {
  LeftOut left_out;  // of this mesh
  uint64_t vertices = 0;
  uint32_t is_mirrored = 0;
  uint32_t is_undeformed = 0;  // a skin or blend shapes deform it elsewhere
};

// In the child.
class NamedMeshSender {
 public:
  explicit NamedMeshSender(DecoderOutput* out) : out_(*out), mesh_(out) {}

  // `names`: separated by zero bytes; the last is the name of the mesh.
  void begin(const NamedMeshHead& head, const std::string& names);
  void vertex(const Point& p) { mesh_.vertex(p); }
  // Of the polygons from here on.
  void material(const std::string& name, const std::optional<Colour>& colour);
  // The next image, number 1 first: a PNG or JPEG file in the scene.
  void image(const std::string& name, std::span<const std::byte> bytes);
  // After material(): its polygons have PaintedCorners.
  void paint(const NamedPaint& paint);
  void polygon(std::span<const uint32_t> corners, std::span<const PaintedCorner> paint = {}) {
    mesh_.polygon(corners, paint);
  }
  void end() { mesh_.finish(); }

  // What belongs to no mesh.
  void left_out(const LeftOut& left_out);
  // The length of a unit of the coordinates, in metres.
  void unit(double metres);

 private:
  DecoderOutput& out_;
  DecodedMeshSender mesh_;
};

// Decodes the bytes of a file, in the child. `path`: of the file, for errors.
using NamedMeshDecoder = std::function<void(std::span<const std::byte> bytes,
                                            const std::string& path, NamedMeshSender* out)>;

// Reads a file with a decoder that needs all of its bytes. `format`: "FBX".
LeftOut read_named_meshes(const File& file, const char* format, const ReadOptions& options,
                          MeshWriter* out, const NamedMeshDecoder& decode);

}  // namespace svdag
