#include "io/scene/gltf/document/gltf_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "io/scene/decoders/draco.h"
#include "io/scene/decoders/meshopt.h"
#include "io/scene/gltf/document/gltf_json.h"
#include "streaming/error.h"

namespace svdag {
namespace {

using nlohmann::json;

// Some programs write 1.0 for 1.
std::optional<uint64_t> whole(const json& value) {
  if (value.is_number_unsigned()) return value.get<uint64_t>();
  if (!value.is_number_float()) return {};
  const double number = value.get<double>();
  const bool fits = number >= 0 && number < 0x1p53 && number == std::floor(number);
  return fits ? std::optional(uint64_t(number)) : std::nullopt;
}

constexpr uint32_t kJsonChunk = 0x4E4F534A;
constexpr uint32_t kBinChunk = 0x004E4942;

uint32_t u32_at(const File& file, uint64_t offset) {
  std::array<unsigned char, 4> b;
  file.read_at(offset, std::as_writable_bytes(std::span(b)));
  return uint32_t(b[0]) | uint32_t(b[1]) << 8 | uint32_t(b[2]) << 16 | uint32_t(b[3]) << 24;
}

struct Chunk {
  uint64_t begin;
  uint64_t size;
  uint32_t type;
  uint64_t end() const { return begin + size; }
};

Chunk chunk_at(const File& file, uint64_t offset, uint64_t end) {
  if (end - offset < 8) fail_input(file.path(), "is cut off inside a GLB chunk header", offset);
  const Chunk chunk{offset + 8, u32_at(file, offset), u32_at(file, offset + 4)};
  if (chunk.size > end - chunk.begin) {
    fail_input(file.path(), "has a GLB chunk that is longer than the file", offset);
  }
  return chunk;
}

// Header (magic, version, length), then the JSON chunk, then at most one BIN chunk.
void load_glb(GltfDocument* document, GltfParts parts, GltfBytes bytes) {
  const File& file = *document->file;
  const uint64_t begin = bytes.begin;
  if (u32_at(file, begin + 4) != 2)
    fail_input(file.path(), "is not a GLB file of version 2", begin + 4);
  const uint64_t end = begin + u32_at(file, begin + 8);
  if (end > bytes.end)
    fail_input(file.path(), "is cut off: GLB file shorter than it says", begin + 8);
  const Chunk text = chunk_at(file, begin + 12, std::max(end, begin + 12));
  if (text.type != kJsonChunk)
    fail_input(file.path(), "does not begin with a JSON chunk", begin + 12);
  document->json = parse_gltf_json(file, text.begin, text.end(), parts, &document->memory);
  if (text.end() == end) return;
  const Chunk binary = chunk_at(file, text.end(), end);
  if (binary.type != kBinChunk) return;
  document->bin = binary.begin;
  document->bin_size = binary.size;
}

bool supported(const std::string& extension) {
  if (extension == "KHR_draco_mesh_compression") return has_draco();
  if (is_meshopt_extension(extension)) return has_meshopt();
  constexpr std::array<std::string_view, 16> kKnown = {"KHR_mesh_quantization",
                                                       "EXT_mesh_gpu_instancing",
                                                       "KHR_texture_transform",
                                                       "KHR_texture_basisu",
                                                       "EXT_texture_webp",
                                                       "EXT_texture_avif",
                                                       "MSFT_texture_dds",
                                                       "KHR_lights_punctual",
                                                       "EXT_lights_image_based",
                                                       "KHR_animation_pointer",
                                                       "KHR_xmp_json_ld",
                                                       "KHR_node_visibility",
                                                       "CESIUM_RTC",
                                                       "EXT_mesh_features",
                                                       "EXT_instance_features",
                                                       "EXT_structural_metadata"};
  return extension.starts_with("KHR_materials_") ||
         std::find(kKnown.begin(), kKnown.end(), extension) != kKnown.end();
}

void check_document(const GltfDocument& document) {
  const JsonObject root = document.root();
  const std::string& path = document.file->path();
  if (!root.has("asset") || !root.object("asset").text("version").starts_with("2.")) {
    fail_input(path, "is not glTF 2: its asset.version does not begin with \"2.\"");
  }
  for (const json& name : root.array("extensionsRequired")) {
    if (!name.is_string()) fail_input(path, "has an extension whose name is not a string");
    if (supported(name.get_ref<const std::string&>())) continue;
    fail_input(path, "requires the glTF extension " + name.dump() + ", which svdag cannot read");
  }
}

}  // namespace

JsonObject::JsonObject(const json& value, const std::string& path) : value_(&value), path_(&path) {
  if (!value.is_object()) fail_input(path, "has something else where its JSON needs an object");
}

std::vector<std::string> JsonObject::names() const {
  std::vector<std::string> names;
  for (const auto& member : value_->items()) names.push_back(member.key());
  return names;
}

const json* JsonObject::find(const char* key) const {
  const auto found = value_->find(key);
  return found == value_->end() ? nullptr : &*found;
}

void JsonObject::fail(const char* key, const char* expected) const {
  const json* value = find(key);
  const std::string is = value == nullptr ? " is missing" : " is not " + std::string(expected);
  fail_input(*path_, "has broken glTF JSON: \"" + std::string(key) + "\"" + is);
}

uint64_t JsonObject::whole_number(const char* key, std::optional<uint64_t> fallback) const {
  const json* value = find(key);
  if (value == nullptr && fallback) return *fallback;
  const auto number = value == nullptr ? std::nullopt : whole(*value);
  if (!number) fail(key, "a whole number");
  return *number;
}

uint64_t JsonObject::index(const json& element, const char* key) const {
  const auto number = whole(element);
  if (!number) fail(key, "an array of whole numbers");
  return *number;
}

bool JsonObject::flag(const char* key) const {
  const json* value = find(key);
  if (value != nullptr && !value->is_boolean()) fail(key, "true or false");
  return value != nullptr && value->get<bool>();
}

const std::string& JsonObject::text(const char* key) const {
  static const std::string kNone;
  const json* value = find(key);
  if (value != nullptr && !value->is_string()) fail(key, "a string");
  return value == nullptr ? kNone : value->get_ref<const std::string&>();
}

JsonObject JsonObject::object(const char* key) const {
  const json* value = find(key);
  if (value == nullptr || !value->is_object()) fail(key, "an object");
  return JsonObject(*value, *path_);
}

std::optional<JsonObject> JsonObject::extension(const char* name) const {
  if (!has("extensions")) return {};
  const JsonObject extensions = object("extensions");
  if (!extensions.has(name)) return {};
  return extensions.object(name);
}

std::span<const json> JsonObject::array(const char* key) const {
  const json* value = find(key);
  if (value == nullptr) return {};
  if (!value->is_array()) fail(key, "an array");
  return value->get_ref<const json::array_t&>();
}

double JsonObject::number(const char* key, double fallback) const {
  const json* value = find(key);
  if (value == nullptr) return fallback;
  if (!value->is_number()) fail(key, "a number");
  return value->get<double>();
}

bool JsonObject::numbers(const char* key, std::span<double> out) const {
  if (!has(key)) return false;
  const auto values = array(key);
  if (values.size() != out.size()) fail(key, "an array of the right length");
  for (size_t i = 0; i < out.size(); ++i) {
    if (!values[i].is_number()) fail(key, "an array of numbers");
    out[i] = values[i].get<double>();
  }
  return true;
}

JsonObject GltfDocument::element(const char* key, uint64_t index) const {
  const auto elements = root().array(key);
  if (index >= elements.size()) {
    fail_input(file->path(), "refers to " + std::string(key) + "[" + std::to_string(index) +
                                 "], but has only " + std::to_string(elements.size()));
  }
  return JsonObject(elements[size_t(index)], file->path());
}

GltfDocument load_gltf(const File& file, MemoryBudget* budget, GltfParts parts, GltfBytes bytes) {
  GltfDocument document;
  document.file = &file;
  document.memory = budget->reserve(0, "parsed glTF nodes");
  std::array<char, 4> magic{};
  bytes.end = std::min(bytes.end, file.size());
  file.read_some_at(bytes.begin, std::as_writable_bytes(std::span(magic)));
  if (std::memcmp(magic.data(), "glTF", 4) == 0) {
    load_glb(&document, parts, bytes);
  } else {
    document.json = parse_gltf_json(file, bytes.begin, bytes.end, parts, &document.memory);
  }
  check_document(document);
  return document;
}

}  // namespace svdag
