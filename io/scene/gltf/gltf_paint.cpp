#include "io/scene/gltf/gltf_paint.h"

#include <span>

#include "io/scene/gltf/document/gltf_elements.h"
#include "io/scene/gltf/gltf_images.h"
#include "streaming/error.h"

namespace svdag {
namespace {

std::array<double, 4> factor_of(const GltfBaseColour& base) {
  std::array<double, 4> factor{1, 1, 1, 1};
  if (base.object) base.object->numbers(base.factor, factor);
  return factor;
}

}  // namespace

GltfPaint paint_of(const GltfDocument& document, const JsonObject& material, double threshold,
                   GltfBuffers* buffers, LinearImages* images) {
  GltfPaint result;
  const GltfBaseColour base = base_colour_of(material);
  const std::array<double, 4> factor = factor_of(base);
  for (size_t c = 0; c < 3; ++c) result.paint.factor[c] = double(light16(factor[c])) / kWhite16;
  const auto use = texture_use_of(document, base);
  if (!use) return result;
  const GltfImage image = image_of_texture(document, use->texture);
  result.paint.image = images->image(image.name, threshold, [&](MemoryBudget::Reservation* memory) {
    return read_image(document, image, buffers, images->budget(), memory);
  });
  if (!result.paint.image) return result;
  result.use = *use;
  result.paint.wrap_u = use->wrap_u;
  result.paint.wrap_v = use->wrap_v;
  result.paint.nearest = use->nearest;
  return result;
}

Colour factor_colour(const JsonObject& material) {
  const std::array<double, 4> factor = factor_of(base_colour_of(material));
  return LinearColour().times({factor[0], factor[1], factor[2]});
}

std::vector<VertexColour> vertex_colours(const Accessor& accessor, uint64_t vertices,
                                         MemoryBudget* budget, MemoryBudget::Reservation* memory,
                                         LeftOut* left_out) {
  std::vector<VertexColour> colours;
  const size_t components = accessor.base.components;
  if (components != 3 && components != 4)
    fail_input(*accessor.path, "has colours of vertices that are neither VEC3 nor VEC4");
  if (accessor.count() != vertices)
    fail_input(*accessor.path, "has a primitive with " + std::to_string(accessor.count()) +
                                   " colours for " + std::to_string(vertices) + " vertices");
  *memory = budget->reserve(vertices * sizeof(VertexColour), "colours of vertices");
  colours.reserve(size_t(vertices));
  ElementStream stream(accessor);
  std::array<double, 3072> window;
  while (const size_t n = stream.read(std::span<double>(window))) {
    for (size_t i = 0; i < n; ++i) {
      const double* const value = &window[components * i];
      colours.push_back({light16(value[0]), light16(value[1]), light16(value[2])});
      left_out->add(Omission::kBrightColours, value[0] > 1 || value[1] > 1 || value[2] > 1);
    }
  }
  return colours;
}

}  // namespace svdag
