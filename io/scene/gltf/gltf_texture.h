// How a material of glTF uses the texture of its base colour: which one, with which coordinates,
// wrapped in which way.
//
// A texture coordinate goes through KHR_texture_transform first: the offset is added to the
// rotated, scaled coordinate; then it is multiplied by the size of the image. A primitive without
// the coordinates that its material names has no texture.
#pragma once

#include <optional>
#include <vector>

#include "io/scene/cutouts/cut_out.h"
#include "io/scene/gltf/document/gltf_buffers.h"
#include "io/scene/gltf/document/gltf_document.h"

namespace svdag {

// The object with the texture and the factor of the base colour, and their names in it.
struct GltfBaseColour {
  std::optional<JsonObject> object;
  const char* texture = "baseColorTexture";
  const char* factor = "baseColorFactor";
};
// Of the diffuse colour for KHR_materials_pbrSpecularGlossiness.
GltfBaseColour base_colour_of(const JsonObject& material);

struct GltfTextureUse {
  uint64_t texture = 0;
  std::optional<uint64_t> set;  // n of TEXCOORD_n; none: no texture
  double offset[2] = {0, 0}, scale[2] = {1, 1}, sine = 0, cosine = 1;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  bool nearest = false;  // magFilter

  // In texels of an image of this size.
  TexturePoint place(double u, double v, int64_t width, int64_t height) const {
    const double x = scale[0] * u, y = scale[1] * v;
    return {(cosine * x + sine * y + offset[0]) * double(width),
            (cosine * y - sine * x + offset[1]) * double(height)};
  }
};
// None: the base colour has no texture.
std::optional<GltfTextureUse> texture_use_of(const GltfDocument& document,
                                             const GltfBaseColour& base);

// The name of the attribute with the coordinates of `use`, which has a set.
std::string texture_attribute(const GltfTextureUse& use);
// Whether a primitive with these attributes has them.
bool has_texture_points(const GltfTextureUse& use, const JsonObject& attributes);
// The texture coordinates of all vertices of a primitive, in texels of an image of this size,
// reserved in *memory. Unless they may be anywhere, those that are not placeable are an Error
// (kBadInput), with the way out of a cut-out.
std::vector<TexturePoint> texture_points(const GltfTextureUse& use, int64_t width, int64_t height,
                                         const Accessor& coordinates, uint64_t vertices,
                                         bool anywhere, MemoryBudget* budget,
                                         MemoryBudget::Reservation* memory);

}  // namespace svdag
