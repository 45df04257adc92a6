// The texture that colours a material of OBJ: its map_Kd.
//
// A map_Kd replaces Kd, as in Blender: exporters leave Kd black, grey or white beside it.
// Multiplying by it, as three.js does, makes the first of these scenes black. Faces without texture
// coordinates, and materials whose image cannot be read, have Kd.
//
// What cuts the material out makes holes in the texture. An image of its own (map_d) is looked up
// at the centres of the texels; one that is placed by other options is not followed.
#pragma once

#include <optional>

#include "io/scene/colours/linear_images.h"
#include "io/scene/colours/paint.h"
#include "io/scene/readers/mtl.h"
#include "io/scene/readers/obj_cut_out.h"

namespace svdag {

struct ObjPaint {
  Paint paint;
  const MtlTexture* use = nullptr;
};

// Nothing: the material has no texture that can be read. `cut`: what cuts it out, or null.
std::optional<ObjPaint> paint_of(const MtlMaterial& material, const ObjCutOut* cut,
                                 LinearImages* images);

}  // namespace svdag
