#include "io/scene/gltf/gltf_images.h"

#include "io/scene/gltf/document/gltf_uri.h"
#include "streaming/error.h"

namespace svdag {

std::vector<File> image_files(const GltfDocument& document) {
  std::vector<File> files;
  for (const auto& value : document.root().array("images")) {
    try {
      const std::string& uri = JsonObject(value, document.file->path()).text("uri");
      if (uri.empty() || is_data_uri(uri)) continue;
      files.push_back(open_beside(document.file->path(), uri, "image"));
    } catch (const Error&) {  // reported when the image is needed
    }
  }
  return files;
}

GltfImage image_of_texture(const GltfDocument& document, uint64_t number) {
  const std::string& path = document.file->path();
  const auto textures = document.root().array("textures");
  if (number >= textures.size() || !JsonObject(textures[number], path).has("source"))
    return {{}, path + ": textures[" + std::to_string(number) + "]"};
  const uint64_t index = JsonObject(textures[number], path).whole_number("source");
  return {index, path + ": images[" + std::to_string(index) + "]"};
}

std::vector<std::byte> read_image(const GltfDocument& document, const GltfImage& image,
                                  GltfBuffers* buffers, MemoryBudget* budget,
                                  MemoryBudget::Reservation* memory) {
  // One of an extension, perhaps.
  if (!image.index) fail_input(image.name, "has no PNG or JPEG image");
  const std::string& path = document.file->path();
  const JsonObject object = document.element("images", *image.index);
  const std::string& uri = object.text("uri");
  if (uri.empty()) return buffers->view_bytes(object.whole_number("bufferView"), memory);
  if (!is_data_uri(uri)) return bytes_of_image(open_beside(path, uri, "image"), budget, memory);
  *memory = budget->reserve(uri.size(), "textures");
  return decode_data_uri(uri, path);
}

}  // namespace svdag
