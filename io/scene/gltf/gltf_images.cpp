#include "io/scene/gltf/gltf_images.h"

#include "io/scene/gltf/gltf_uri.h"
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

std::optional<ImageMean> mean_of_texture(const GltfDocument& document, const JsonObject& info,
                                         GltfBuffers* buffers, ImageMeans* means) {
  const std::string& path = document.file->path();
  const uint64_t number = info.whole_number("index");
  const auto textures = document.root().array("textures");
  if (number >= textures.size() || !JsonObject(textures[number], path).has("source")) {
    const std::string name = path + ": textures[" + std::to_string(number) + "]";
    return means->mean(name, [&](MemoryBudget::Reservation*) -> std::vector<std::byte> {
      fail_input(name, "has no PNG or JPEG image");  // one of an extension, perhaps
    });
  }
  const uint64_t index = JsonObject(textures[number], path).whole_number("source");
  const std::string name = path + ": images[" + std::to_string(index) + "]";
  return means->mean(name, [&](MemoryBudget::Reservation* memory) {
    const JsonObject image = document.element("images", index);
    const std::string& uri = image.text("uri");
    if (uri.empty()) return buffers->view_bytes(image.whole_number("bufferView"), memory);
    if (!is_data_uri(uri)) return means->bytes_of(open_beside(path, uri, "image"), memory);
    *memory = means->budget()->reserve(uri.size(), "textures");
    return decode_data_uri(uri, path);
  });
}

}  // namespace svdag
