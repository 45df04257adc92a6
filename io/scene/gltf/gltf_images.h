// The images of a glTF file: files beside it, data URIs, or buffer views. Needs a document that was
// loaded with its images.
#pragma once

#include <optional>
#include <vector>

#include "io/scene/decoders/image.h"
#include "io/scene/gltf/document/gltf_buffers.h"
#include "io/scene/gltf/document/gltf_document.h"

namespace svdag {

// The files that images are in; none for one that cannot be opened.
std::vector<File> image_files(const GltfDocument& document);

// The number of an image of a document, and a name that is unique to it.
struct GltfImage {
  std::optional<uint64_t> index;  // none: the texture has no PNG or JPEG image
  std::string name;
};
// Of texture `number`.
GltfImage image_of_texture(const GltfDocument& document, uint64_t number);
// Its bytes, reserved in *memory.
std::vector<std::byte> read_image(const GltfDocument& document, const GltfImage& image,
                                  GltfBuffers* buffers, MemoryBudget* budget,
                                  MemoryBudget::Reservation* memory);

}  // namespace svdag
