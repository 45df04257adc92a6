// The one colour of a material, which its layer has: the factor of its base colour, times the mean
// of its texture where triangles of the document use it (io/scene/colours/used_mean.h).
//
// Primitives of more than kMaxVertices vertices, and compressed ones, are left out; if all are, the
// mean is that of the whole image. So little memory is needed, and the colour does not depend on
// it. Rejected: the whole image always (the tyres of a truck are white, as most of its atlas is).
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "io/colour.h"
#include "io/scene/colours/linear_images.h"
#include "io/scene/colours/used_mean.h"
#include "io/scene/gltf/document/gltf_buffers.h"
#include "io/scene/gltf/document/gltf_document.h"
#include "io/scene/gltf/gltf_texture.h"

namespace svdag {

class GltfMeanColours {
 public:
  static constexpr uint64_t kMaxVertices = uint64_t(1) << 18;

  // All must outlive this.
  GltfMeanColours(const GltfDocument& document, GltfBuffers* buffers)
      : document_(document), buffers_(*buffers) {}

  // None: the material has neither factor nor a texture that can be read.
  std::optional<Colour> of(uint64_t material, LinearImages* images);

 private:
  std::optional<Colour> find(uint64_t material, LinearImages* images);
  void find_primitives();
  void add(const JsonObject& primitive, const GltfTextureUse& use, const LinearImage& image,
           LinearImages* images, UsedMean* mean);

  const GltfDocument& document_;
  GltfBuffers& buffers_;
  bool has_primitives_ = false;
  std::map<uint64_t, std::vector<const nlohmann::json*>> primitives_;  // of triangles, by material
  std::map<uint64_t, std::optional<Colour>> known_;
};

}  // namespace svdag
