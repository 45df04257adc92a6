// The colours of the points of a glTF primitive: base colour texture x factor x COLOR_0.
#pragma once

#include <vector>

#include "io/scene/colours/linear_images.h"
#include "io/scene/colours/paint.h"
#include "io/scene/gltf/gltf_texture.h"

namespace svdag {

struct GltfPaint {
  Paint paint;
  GltfTextureUse use;  // without a set: no texture
};

// Of a material. Texels with an alpha below `threshold` are cut out.
GltfPaint paint_of(const GltfDocument& document, const JsonObject& material, double threshold,
                   GltfBuffers* buffers, LinearImages* images);

// The base colour's factor, as a colour: that of a material without texture.
Colour factor_colour(const JsonObject& material);

// COLOR_0 of all vertices of a primitive, reserved in *memory; values beyond 1 are clamped and
// counted.
std::vector<VertexColour> vertex_colours(const Accessor& accessor, uint64_t vertices,
                                         MemoryBudget* budget, MemoryBudget::Reservation* memory,
                                         LeftOut* left_out);

}  // namespace svdag
