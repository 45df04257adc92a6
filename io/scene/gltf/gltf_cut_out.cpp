#include "io/scene/gltf/gltf_cut_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "io/scene/gltf/gltf_elements.h"
#include "io/scene/gltf/gltf_images.h"
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

void set_sampler(const GltfDocument& document, uint64_t texture, CutOut* cut) {
  const JsonObject object = document.element("textures", texture);
  if (!object.has("sampler")) return;
  const JsonObject sampler = document.element("samplers", object.whole_number("sampler"));
  cut->nearest = sampler.has("magFilter") && sampler.whole_number("magFilter") == kNearest;
  cut->wrap_u = wrap_of(sampler, "wrapS");
  cut->wrap_v = wrap_of(sampler, "wrapT");
}

void set_transform(const JsonObject& info, GltfCutOut* cut) {
  const auto transform = info.extension("KHR_texture_transform");
  if (!transform) return;
  transform->numbers("offset", cut->offset);
  transform->numbers("scale", cut->scale);
  const double rotation = transform->number("rotation", 0);
  cut->sine = sine_of_angle(rotation);
  cut->cosine = cosine_of_angle(rotation);
  cut->texture_set = transform->whole_number("texCoord", cut->texture_set);
}

// The object with the texture and the factor of the base colour, and their names in it.
struct BaseColour {
  std::optional<JsonObject> object;
  const char* texture = "baseColorTexture";
  const char* factor = "baseColorFactor";
};

BaseColour base_colour_of(const JsonObject& material) {
  if (const auto other = material.extension("KHR_materials_pbrSpecularGlossiness"))
    return {other, "diffuseTexture", "diffuseFactor"};
  if (material.has("pbrMetallicRoughness")) return {material.object("pbrMetallicRoughness")};
  return {};
}

bool is_mask(const JsonObject& material) {
  return material.text("alphaMode") == "MASK";
}

std::string key_of(const GltfCutOut& cut) {
  return "TEXCOORD_" + std::to_string(cut.texture_set.value_or(0));
}

// Looks at every material, so that every pattern that matches one is recorded.
bool has_cut_out(const GltfDocument& document, const NameFilter& names) {
  return std::ranges::count_if(document.root().array("materials"),
                               [&](const nlohmann::json& value) {
                                 return is_cut_out(JsonObject(value, document.file->path()), names);
                               }) > 0;
}

}  // namespace

TexturePoint GltfCutOut::place(double u, double v) const {
  const double x = scale[0] * u, y = scale[1] * v;
  return {(cosine * x + sine * y + offset[0]) * double(cut.image->width()),
          (cosine * y - sine * x + offset[1]) * double(cut.image->height())};
}

bool has_base_texture(const JsonObject& material) {
  const BaseColour base = base_colour_of(material);
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
  const BaseColour base = base_colour_of(material);
  std::array<double, 4> factor{1, 1, 1, 1};
  if (base.object) base.object->numbers(base.factor, factor);
  const double cutoff = is_mask(material) ? material.number("alphaCutoff", 0.5) : 0.5;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  result.cut.threshold = cutoff <= 0 ? 0 : factor[3] > 0 ? cutoff * 255 / factor[3] : kNever;
  result.cut.image = images->opaque();
  if (!base.object || !base.object->has(base.texture)) return result;
  const JsonObject info = base.object->object(base.texture);
  const uint64_t texture = info.whole_number("index");
  result.texture_set = info.whole_number("texCoord", 0);
  set_transform(info, &result);
  const GltfImage image = image_of_texture(document, texture);
  result.cut.image = images->image(image.name, [&](MemoryBudget::Reservation* memory) {
    return read_image(document, image, buffers, images->budget(), memory);
  });
  set_sampler(document, texture, &result.cut);
  return result;
}

bool has_vertex_alpha(const GltfDocument& document, const JsonObject& primitive,
                      GltfBuffers* buffers) {
  const JsonObject attributes = primitive.object("attributes");
  if (!attributes.has("COLOR_0")) return false;
  const uint64_t number = attributes.whole_number("COLOR_0");
  if (document.element("accessors", number).text("type") != "VEC4") return false;
  ElementStream colours(buffers->accessor(number, "VEC4"));
  std::array<double, 2048> window;
  while (const size_t n = colours.read(std::span<double>(window))) {
    for (size_t i = 0; i < n; ++i) {
      if (window[4 * i + 3] != 1) return true;
    }
  }
  return false;
}

bool has_texture_points(const GltfCutOut& cut, const JsonObject& primitive) {
  return cut.texture_set && primitive.object("attributes").has(key_of(cut).c_str());
}

std::vector<TexturePoint> texture_points(const GltfCutOut& cut, const JsonObject& primitive,
                                         uint64_t vertices, GltfBuffers* buffers,
                                         MemoryBudget* budget, MemoryBudget::Reservation* memory) {
  *memory = budget->reserve(vertices * sizeof(TexturePoint), "texture coordinates of cut-outs");
  std::vector<TexturePoint> points;
  points.reserve(size_t(vertices));
  if (!has_texture_points(cut, primitive)) {
    points.resize(size_t(vertices));
    return points;
  }
  const uint64_t number = primitive.object("attributes").whole_number(key_of(cut).c_str());
  const Accessor accessor = buffers->accessor(number, "VEC2");
  if (accessor.count() != vertices)
    fail_input(primitive.path(), "has a primitive with " + std::to_string(accessor.count()) +
                                     " texture coordinates for " + std::to_string(vertices) +
                                     " vertices");
  ElementStream stream(accessor);
  std::array<double, 2048> window;
  while (const size_t n = stream.read(std::span<double>(window))) {
    for (size_t i = 0; i < n; ++i) {
      const TexturePoint p = cut.place(window[2 * i], window[2 * i + 1]);
      const auto is_near = [](double x) { return std::abs(x) < kMaxTextureCoordinate; };
      if (!is_near(p.u) || !is_near(p.v))
        fail_input(primitive.path(),
                   "has a texture coordinate of a cut-out that is NaN, infinite or beyond 2^40 "
                   "texels (--no-cutouts bakes materials whole)");
      points.push_back(p);
    }
  }
  return points;
}

}  // namespace svdag
