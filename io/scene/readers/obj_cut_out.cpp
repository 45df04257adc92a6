#include "io/scene/readers/obj_cut_out.h"

#include <algorithm>
#include <limits>

#include "streaming/error.h"

namespace svdag {

TexturePoint ObjCutOut::place(double u, double v) const {
  return {(u * scale[0] + offset[0]) * double(cut.image->width()),
          (1 - (v * scale[1] + offset[1])) * double(cut.image->height())};
}

std::optional<ObjCutOut> cut_out_of(const std::string& name, const MtlMaterial& material,
                                    const NameFilter& names, const std::string& obj,
                                    AlphaImages* images) {
  const MtlTexture* const texture = cutting_texture(name, material, names);
  if (texture == nullptr) return {};
  if (!texture->unknown.empty())
    fail_input(obj, "the texture that cuts out the material \"" + name + "\" has the option " +
                        texture->unknown +
                        ", which svdag does not follow (--no-cutouts bakes materials whole)");
  ObjCutOut result{};
  std::ranges::copy(texture->scale, result.scale);
  std::ranges::copy(texture->offset, result.offset);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  result.cut.threshold = material.dissolve > 0 ? 127.5 / material.dissolve : kNever;
  if (texture->clamp) result.cut.wrap_u = result.cut.wrap_v = Wrap::kClamp;
  const auto read = [&](MemoryBudget::Reservation* memory) {
    if (texture->is_outside)
      fail_input(texture->path, "is outside the folder of the scene: --allow-outside reads it");
    return bytes_of_image(File::open_read(texture->path), images->budget(), memory);
  };
  result.cut.image = images->image(texture->path, read, texture == material.mask.get());
  return result;
}

}  // namespace svdag
