#include "io/scene/gltf/gltf_texture.h"

#include <array>
#include <span>
#include <string>

#include "io/scene/gltf/document/gltf_elements.h"
#include "io/trigonometry.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint64_t kNearest = 9728, kClampToEdge = 33071, kMirroredRepeat = 33648, kRepeat = 10497;

Wrap wrap_of(const JsonObject& sampler, const char* key) {
  const uint64_t wrap = sampler.whole_number(key, kRepeat);
  if (wrap == kClampToEdge) return Wrap::kClamp;
  return wrap == kMirroredRepeat ? Wrap::kMirror : Wrap::kRepeat;
}

void set_sampler(const GltfDocument& document, GltfTextureUse* use) {
  const std::string& path = document.file->path();
  const auto textures = document.root().array("textures");
  if (use->texture >= textures.size()) return;
  const JsonObject object(textures[use->texture], path);
  if (!object.has("sampler")) return;
  const JsonObject sampler = document.element("samplers", object.whole_number("sampler"));
  use->nearest = sampler.has("magFilter") && sampler.whole_number("magFilter") == kNearest;
  use->wrap_u = wrap_of(sampler, "wrapS");
  use->wrap_v = wrap_of(sampler, "wrapT");
}

void set_transform(const JsonObject& info, GltfTextureUse* use) {
  const auto transform = info.extension("KHR_texture_transform");
  if (!transform) return;
  transform->numbers("offset", use->offset);
  transform->numbers("scale", use->scale);
  const double rotation = transform->number("rotation", 0);
  use->sine = sine_of_angle(rotation);
  use->cosine = cosine_of_angle(rotation);
  use->set = transform->whole_number("texCoord", *use->set);
}

}  // namespace

GltfBaseColour base_colour_of(const JsonObject& material) {
  if (const auto other = material.extension("KHR_materials_pbrSpecularGlossiness"))
    return {other, "diffuseTexture", "diffuseFactor"};
  if (material.has("pbrMetallicRoughness")) return {material.object("pbrMetallicRoughness")};
  return {};
}

std::optional<GltfTextureUse> texture_use_of(const GltfDocument& document,
                                             const GltfBaseColour& base) {
  if (!base.object || !base.object->has(base.texture)) return {};
  const JsonObject info = base.object->object(base.texture);
  GltfTextureUse use;
  use.texture = info.whole_number("index");
  use.set = info.whole_number("texCoord", 0);
  set_transform(info, &use);
  set_sampler(document, &use);
  return use;
}

std::string texture_attribute(const GltfTextureUse& use) {
  return "TEXCOORD_" + std::to_string(*use.set);
}

bool has_texture_points(const GltfTextureUse& use, const JsonObject& attributes) {
  return use.set && attributes.has(texture_attribute(use).c_str());
}

std::vector<TexturePoint> texture_points(const GltfTextureUse& use, int64_t width, int64_t height,
                                         const Accessor& coordinates, uint64_t vertices,
                                         bool anywhere, MemoryBudget* budget,
                                         MemoryBudget::Reservation* memory) {
  *memory = budget->reserve(vertices * sizeof(TexturePoint), "texture coordinates");
  std::vector<TexturePoint> points;
  points.reserve(size_t(vertices));
  if (coordinates.count() != vertices)
    fail_input(*coordinates.path, "has a primitive with " + std::to_string(coordinates.count()) +
                                      " texture coordinates for " + std::to_string(vertices) +
                                      " vertices");
  ElementStream stream(coordinates);
  std::array<double, 2048> window;
  while (const size_t n = stream.read(std::span<double>(window))) {
    for (size_t i = 0; i < n; ++i) {
      const TexturePoint p = use.place(window[2 * i], window[2 * i + 1], width, height);
      if (!anywhere && !is_placeable(p))
        fail_input(*coordinates.path,
                   "has a texture coordinate that is NaN, infinite or beyond 2^40 texels "
                   "(--no-cutouts bakes materials whole)");
      points.push_back(p);
    }
  }
  return points;
}

}  // namespace svdag
