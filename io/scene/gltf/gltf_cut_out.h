// Materials of glTF whose transparent points are cut out: those with alphaMode MASK (3.9.4 of the
// specification).
//
// A point is opaque if the alpha of the base colour's texture times that of its factor reaches
// alphaCutoff. A texture coordinate goes through KHR_texture_transform first: the offset is added
// to the rotated, scaled coordinate; then it is multiplied by the size of the image. A primitive
// without the coordinates that its material names has no texture. The alpha of COLOR_0 is not read.
#pragma once

#include <optional>
#include <vector>

#include "io/scene/cutouts/alpha_images.h"
#include "io/scene/cutouts/cut_out.h"
#include "io/scene/gltf/gltf_buffers.h"
#include "io/scene/gltf/gltf_document.h"

namespace svdag {

struct GltfCutOut {
  CutOut cut;
  std::optional<uint64_t> texture_set;  // n of TEXCOORD_n; none: no texture
  double offset[2] = {0, 0}, scale[2] = {1, 1}, sine = 0, cosine = 1;

  // In texels of the image.
  TexturePoint place(double u, double v) const;
};

bool is_mask(const JsonObject& material);
// As load_gltf(), with images if a material has a mask: images may be a large part of the JSON.
GltfDocument load_with_masks(const File& file, MemoryBudget* budget, GltfParts parts,
                             GltfBytes bytes);

// `material`: with is_mask(), of a document that was loaded with its images.
GltfCutOut cut_out_of(const GltfDocument& document, const JsonObject& material,
                      GltfBuffers* buffers, AlphaImages* images);

// The texture coordinates of all vertices of `primitive`, reserved in *memory. Coordinates that are
// not finite, or beyond 2^40 texels, are an Error (kBadInput).
std::vector<TexturePoint> texture_points(const GltfCutOut& cut, const JsonObject& primitive,
                                         uint64_t vertices, GltfBuffers* buffers,
                                         MemoryBudget* budget, MemoryBudget::Reservation* memory);

}  // namespace svdag
