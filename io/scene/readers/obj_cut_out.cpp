#include "io/scene/readers/obj_cut_out.h"

#include <limits>

#include "streaming/error.h"

namespace svdag {

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
  result.use = texture;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  result.cut.threshold = material.dissolve > 0 ? 127.5 / material.dissolve : kNever;
  result.cut.wrap_u = result.cut.wrap_v = texture->wrap();
  const auto read = [&](MemoryBudget::Reservation* memory) {
    if (texture->is_outside)
      fail_input(texture->path, "is outside the folder of the scene: --allow-outside reads it");
    return bytes_of_image(File::open_read(texture->path), images->budget(), memory);
  };
  result.cut.image = images->image(texture->path, read, texture == material.mask.get());
  return result;
}

}  // namespace svdag
