#include "io/scene/gltf/gltf_cut_out.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>

#include "io/scene/gltf/gltf_images.h"
#include "streaming/error.h"

namespace svdag {
namespace {

bool has_mask(const GltfDocument& document) {
  return std::ranges::any_of(document.root().array("materials"), [&](const nlohmann::json& value) {
    return is_mask(JsonObject(value, document.file->path()));
  });
}

}  // namespace

bool is_mask(const JsonObject& material) {
  return material.text("alphaMode") == "MASK";
}

GltfDocument load_with_masks(const File& file, MemoryBudget* budget, GltfParts parts,
                             GltfBytes bytes) {
  GltfDocument document = load_gltf(file, budget, parts, bytes);
  if (parts.images || !has_mask(document)) return document;
  document = GltfDocument();
  parts.images = true;
  return load_gltf(file, budget, parts, bytes);
}

GltfCutOut cut_out_of(const GltfDocument& document, const JsonObject& material,
                      GltfBuffers* buffers, AlphaImages* images) {
  GltfCutOut result;
  const GltfBaseColour base = base_colour_of(material);
  std::array<double, 4> factor{1, 1, 1, 1};
  if (base.object) base.object->numbers(base.factor, factor);
  const double cutoff = material.number("alphaCutoff", 0.5);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  result.cut.threshold = cutoff <= 0 ? 0 : factor[3] > 0 ? cutoff * 255 / factor[3] : kNever;
  result.cut.image = images->opaque();
  const auto use = texture_use_of(document, base);
  if (!use) return result;
  result.use = *use;
  const GltfImage image = image_of_texture(document, use->texture);
  result.cut.image = images->image(image.name, [&](MemoryBudget::Reservation* memory) {
    return read_image(document, image, buffers, images->budget(), memory);
  });
  result.cut.wrap_u = use->wrap_u;
  result.cut.wrap_v = use->wrap_v;
  result.cut.nearest = use->nearest;
  return result;
}

}  // namespace svdag
