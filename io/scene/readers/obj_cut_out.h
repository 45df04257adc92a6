// Materials of OBJ whose transparent points are cut out: those with map_d, and those with a map_Kd
// that --cutout names.
//
// A point is opaque if alpha times d reaches 0.5. The alpha of a map_d is that of its image, or its
// luminance if it has none; of a map_Kd, that of its image. Between texels alpha is bilinear, as
// the format says nothing.
#pragma once

#include <optional>
#include <string>

#include "io/scene/cutouts/alpha_images.h"
#include "io/scene/cutouts/cut_out.h"
#include "io/scene/readers/mtl.h"

namespace svdag {

struct ObjCutOut {
  CutOut cut;
  const MtlTexture* use = nullptr;
};

// Nothing: the material is whole. An image that cannot be read, or an option of it that would
// change its alpha and is not followed, is an Error (kBadInput).
std::optional<ObjCutOut> cut_out_of(const std::string& name, const MtlMaterial& material,
                                    const NameFilter& names, const std::string& obj,
                                    AlphaImages* images);

}  // namespace svdag
