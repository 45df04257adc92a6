// The Draco primitives of a glTF file, decoded into plain accessors: in a file without a name, so
// that large ones need no memory, and each once however many nodes draw it.
//
// A child process decodes several primitives in the order of the file, beginning with the one that
// is needed: to start a child costs as much as to decode some thousand triangles.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "io/scene/decoders/draco.h"
#include "io/scene/gltf/document/gltf_buffers.h"

namespace svdag {

struct DracoPrimitive {
  Accessor positions, indices;
  // Texture coordinates and colours, if colours of points are wanted or the material is cut out.
  std::map<std::string, Accessor> attributes;
  double step = 0;  // distance of the quantised positions, 0 if they are not
};

class DracoPrimitives {
 public:
  DracoPrimitives(const GltfDocument& document, GltfBuffers* buffers, const ReadOptions& options)
      : document_(document), buffers_(*buffers), options_(options) {}

  // The primitive that this JSON value describes, or null if it has plain data, which is exact, or
  // no Draco data.
  const DracoPrimitive* find(const nlohmann::json& primitive);
  // Whether find() would decode it.
  bool holds(const JsonObject& primitive) const;
  // The attributes of a primitive: if find() would decode it, those that it would find.
  JsonObject attributes_of(const JsonObject& primitive) const;

 private:
  struct Unpacked {
    Blob positions, attributes, indices;
    DracoPrimitive primitive;
  };
  // The compressed bytes of a primitive.
  struct Packed {
    const nlohmann::json* key;
    std::vector<std::byte> bytes;
    MemoryBudget::Reservation memory;
    DracoSource source;
    std::vector<std::string> names;  // of the attributes
  };

  bool has_data(uint64_t accessor) const;
  // Whether its points have places in a texture that is followed.
  bool has_texture(const JsonObject& primitive) const;
  Packed pack(const nlohmann::json& primitive);
  std::vector<Packed> pack_from(const nlohmann::json& primitive);
  void unpack(const std::vector<Packed>& packed);

  const GltfDocument& document_;
  GltfBuffers& buffers_;
  const ReadOptions& options_;
  std::vector<const nlohmann::json*> in_order_;  // all Draco primitives of the file
  bool listed_ = false;
  std::optional<File> file_;  // of all unpacked primitives, one after the other
  uint64_t file_bytes_ = 0;
  std::unordered_map<const nlohmann::json*, Unpacked> unpacked_;
};

}  // namespace svdag
