// Materials of glTF whose transparent points are cut out: those with alphaMode MASK (3.9.4 of the
// specification), and those with a texture that --cutout names.
//
// A point is opaque if the alpha of the base colour's texture times that of its factor reaches
// alphaCutoff, or 0.5 without MASK. A primitive without the coordinates that its material names has
// no texture. The alpha of COLOR_0 is counted, not followed. Rejected: following it. Its product
// with a bilinear alpha may have a maximum inside a polygon, which cut_out.h excludes, and every
// record of a cut triangle would need it.
#pragma once

#include "io/scene/cutouts/alpha_images.h"
#include "io/scene/cutouts/cut_out.h"
#include "io/scene/gltf/document/gltf_buffers.h"
#include "io/scene/gltf/document/gltf_document.h"
#include "io/scene/gltf/gltf_texture.h"
#include "io/scene/mesh/name_filter.h"

namespace svdag {

struct GltfCutOut {
  CutOut cut;
  GltfTextureUse use;  // without a set: no texture
};

// `names`: of --cutout.
bool is_cut_out(const JsonObject& material, const NameFilter& names);
bool has_base_texture(const JsonObject& material);
// As load_gltf(); unless `names` is null, with images if a material is cut out: images may be a
// large part of the JSON.
GltfDocument load_with_cut_outs(const File& file, MemoryBudget* budget, GltfParts parts,
                                GltfBytes bytes, const NameFilter* names);

// `material`: with is_cut_out(), of a document that was loaded with its images.
GltfCutOut cut_out_of(const GltfDocument& document, const JsonObject& material,
                      GltfBuffers* buffers, AlphaImages* images);

// Whether a vertex has another alpha than 1; `colours`: its COLOR_0.
bool has_vertex_alpha(const Accessor& colours);

}  // namespace svdag
