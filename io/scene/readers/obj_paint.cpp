#include "io/scene/readers/obj_paint.h"

#include <algorithm>

namespace svdag {
namespace {

bool is_placed_alike(const MtlTexture& a, const MtlTexture& b) {
  return std::ranges::equal(a.scale, b.scale) && std::ranges::equal(a.offset, b.offset) &&
         a.clamp == b.clamp;
}

}  // namespace

std::optional<ObjPaint> paint_of(const MtlMaterial& material, const ObjCutOut* cut,
                                 LinearImages* images) {
  const MtlTexture* const texture = material.texture.get();
  if (texture == nullptr || texture->is_outside) return {};
  double threshold = 0;
  std::shared_ptr<const AlphaImage> mask;
  if (cut != nullptr && is_placed_alike(*cut->use, *texture)) {
    threshold = cut->cut.threshold;
    if (cut->use != texture) mask = cut->cut.image;
  }
  ObjPaint result{{images->image_of_file(texture->path, threshold, mask)}, texture};
  if (!result.paint.image) return {};
  if (!texture->unknown.empty())
    images->note(texture->path + ": the option " + texture->unknown + " is not followed");
  result.paint.wrap_u = result.paint.wrap_v = texture->wrap();
  return result;
}

}  // namespace svdag
