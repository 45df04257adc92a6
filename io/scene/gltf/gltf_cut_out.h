// Materials of glTF whose transparent points are cut out: those with alphaMode MASK (3.9.4 of the
// specification).
//
// A point is opaque if the alpha of the base colour's texture times that of its factor reaches
// alphaCutoff. The alpha of COLOR_0 is not read.
#pragma once

#include "io/scene/cutouts/alpha_images.h"
#include "io/scene/cutouts/cut_out.h"
#include "io/scene/gltf/gltf_buffers.h"
#include "io/scene/gltf/gltf_document.h"
#include "io/scene/gltf/gltf_texture.h"

namespace svdag {

struct GltfCutOut {
  CutOut cut;
  GltfTextureUse use;  // without a set: no texture
};

bool is_mask(const JsonObject& material);
// As load_gltf(), with images if a material has a mask: images may be a large part of the JSON.
GltfDocument load_with_masks(const File& file, MemoryBudget* budget, GltfParts parts,
                             GltfBytes bytes);

// `material`: with is_mask(), of a document that was loaded with its images.
GltfCutOut cut_out_of(const GltfDocument& document, const JsonObject& material,
                      GltfBuffers* buffers, AlphaImages* images);

}  // namespace svdag
