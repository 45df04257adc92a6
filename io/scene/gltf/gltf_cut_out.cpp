#include "io/scene/gltf/gltf_cut_out.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>

#include "io/scene/gltf/document/gltf_elements.h"
#include "io/scene/gltf/gltf_images.h"
#include "streaming/error.h"

namespace svdag {
namespace {

bool is_mask(const JsonObject& material) {
  return material.text("alphaMode") == "MASK";
}

// Looks at every material, so that every pattern that matches one is recorded.
bool has_cut_out(const GltfDocument& document, const NameFilter& names) {
  return std::ranges::count_if(document.root().array("materials"),
                               [&](const nlohmann::json& value) {
                                 return is_cut_out(JsonObject(value, document.file->path()), names);
                               }) > 0;
}

}  // namespace

bool has_base_texture(const JsonObject& material) {
  const GltfBaseColour base = base_colour_of(material);
  return base.object && base.object->has(base.texture);
}

bool is_cut_out(const JsonObject& material, const NameFilter& names) {
  const bool is_named = names.cuts_out(material.text("name"));  // in any case: it records matches
  return is_mask(material) || (is_named && has_base_texture(material));
}

GltfDocument load_with_cut_outs(const File& file, MemoryBudget* budget, GltfParts parts,
                                GltfBytes bytes, const NameFilter* names) {
  GltfDocument document = load_gltf(file, budget, parts, bytes);
  if (names == nullptr || !has_cut_out(document, *names) || parts.images) return document;
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
  const double cutoff = is_mask(material) ? material.number("alphaCutoff", 0.5) : 0.5;
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

bool has_vertex_alpha(const Accessor& colours) {
  if (colours.base.components != 4) return false;
  ElementStream stream(colours);
  std::array<double, 2048> window;
  while (const size_t n = stream.read(std::span<double>(window))) {
    for (size_t i = 0; i < n; ++i) {
      if (window[4 * i + 3] != 1) return true;
    }
  }
  return false;
}

}  // namespace svdag
