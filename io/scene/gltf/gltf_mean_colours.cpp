#include "io/scene/gltf/gltf_mean_colours.h"

#include "io/scene/gltf/gltf_assembly.h"
#include "io/scene/gltf/gltf_paint.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Of the alpha, in 0 .. 255, of texels that are seen.
double threshold_of(const JsonObject& material) {
  const std::string& mode = material.text("alphaMode");  // absent: OPAQUE, which ignores alpha
  return mode == "MASK" ? 255 * material.number("alphaCutoff", 0.5) : mode == "BLEND" ? 1 : 0;
}

}  // namespace

std::optional<Colour> GltfMeanColours::of(uint64_t material, LinearImages* images) {
  const auto [known, is_new] = known_.try_emplace(material);
  if (is_new) known->second = find(material, images);
  return known->second;
}

std::optional<Colour> GltfMeanColours::find(uint64_t material, LinearImages* images) {
  const JsonObject object = document_.element("materials", material);
  const GltfBaseColour base = base_colour_of(object);
  if (!base.object) return {};
  const GltfPaint painted = paint_of(document_, object, threshold_of(object), &buffers_, images);
  if (!painted.paint.image && !base.object->has(base.factor)) return {};
  LinearColour texels;
  if (painted.paint.image) {
    find_primitives();
    UsedMean mean(painted.paint);
    for (const nlohmann::json* primitive : primitives_[material])
      add(JsonObject(*primitive, document_.file->path()), painted.use, *painted.paint.image, images,
          &mean);
    texels = mean.mean().value_or(LinearColour());
  }
  return texels.times(painted.paint.factor);
}

void GltfMeanColours::find_primitives() {
  if (std::exchange(has_primitives_, true)) return;
  const std::string& path = document_.file->path();
  for (const nlohmann::json& mesh : document_.root().array("meshes")) {
    for (const nlohmann::json& value : JsonObject(mesh, path).array("primitives")) {
      const JsonObject primitive(value, path);
      const uint64_t mode = primitive.whole_number("mode", kTriangles);
      if (primitive.has("material") && mode >= kTriangles && mode <= kTriangleFan)
        primitives_[primitive.whole_number("material")].push_back(&value);
    }
  }
}

void GltfMeanColours::add(const JsonObject& primitive, const GltfTextureUse& use,
                          const LinearImage& image, LinearImages* images, UsedMean* mean) {
  const JsonObject attributes = primitive.object("attributes");
  if (!has_texture_points(use, attributes) || primitive.extension("KHR_draco_mesh_compression"))
    return;
  try {
    const Accessor places =
        buffers_.accessor(attributes.whole_number(texture_attribute(use).c_str()), "VEC2");
    const uint64_t count = places.count();
    if (count > kMaxVertices) return;
    MemoryBudget::Reservation memory;
    const std::vector<TexturePoint> points = texture_points(
        use, image.width(), image.height(), places, count, true, images->budget(), &memory);
    const auto add_triangle = [&](uint64_t a, uint64_t b, uint64_t c) {
      mean->add({points[a], points[b], points[c]});
    };
    const uint64_t mode = primitive.whole_number("mode", kTriangles);
    if (primitive.has("indices")) {
      const Accessor indices = buffers_.accessor(primitive.whole_number("indices"), "SCALAR");
      IndexStream corners(indices, count);
      return assemble(mode, indices.count(), corners, add_triangle);
    }
    uint64_t next = 0;
    auto corners = [&] { return next++; };
    assemble(mode, count, corners, add_triangle);
  } catch (const Error& error) {  // the geometry may not need what is broken
    if (error.code() != ExitCode::kBadInput) throw;
    images->note(error.what());
  }
}

}  // namespace svdag
