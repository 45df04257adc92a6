// The images of a glTF file: files beside it, data URIs, or buffer views. Needs a document that was
// loaded with its images.
#pragma once

#include <optional>
#include <vector>

#include "io/scene/decoders/image.h"
#include "io/scene/gltf/gltf_buffers.h"
#include "io/scene/gltf/gltf_document.h"

namespace svdag {

// The files that images are in; none for one that cannot be opened.
std::vector<File> image_files(const GltfDocument& document);

// The mean of the texture that `info` (as baseColorTexture) names; none, and a note of `means`, if
// it cannot be read.
std::optional<ImageMean> mean_of_texture(const GltfDocument& document, const JsonObject& info,
                                         GltfBuffers* buffers, ImageMeans* means);

}  // namespace svdag
