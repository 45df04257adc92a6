#include "io/scene/gltf/document/gltf_buffers.h"

#include <algorithm>
#include <array>
#include <utility>

#include "io/scene/decoders/meshopt.h"
#include "io/scene/gltf/document/gltf_uri.h"
#include "streaming/error.h"

namespace svdag {
namespace {

uint64_t component_bytes(ComponentType type) {
  switch (type) {
    case ComponentType::kByte:
    case ComponentType::kUnsignedByte:
      return 1;
    case ComponentType::kShort:
    case ComponentType::kUnsignedShort:
      return 2;
    case ComponentType::kUnsignedInt:
    case ComponentType::kFloat:
      return 4;
    case ComponentType::kDouble:
      return 8;
  }
  return 0;
}

// 0 for a type that glTF does not have.
uint32_t component_count(const std::string& type) {
  constexpr std::array<std::pair<const char*, uint32_t>, 7> kTypes = {{{"SCALAR", 1},
                                                                       {"VEC2", 2},
                                                                       {"VEC3", 3},
                                                                       {"VEC4", 4},
                                                                       {"MAT2", 4},
                                                                       {"MAT3", 9},
                                                                       {"MAT4", 16}}};
  for (const auto& [name, components] : kTypes) {
    if (type == name) return components;
  }
  return 0;
}

ComponentType component_type(const JsonObject& object) {
  const uint64_t code = object.whole_number("componentType");
  const auto type = ComponentType(uint32_t(std::min<uint64_t>(code, UINT32_MAX)));
  if (component_bytes(type) == 0 || type == ComponentType::kDouble) {
    fail_input(object.path(),
               "has an accessor of the unknown component type " + std::to_string(code));
  }
  return type;
}

}  // namespace

Blob Blob::in_file(const File* file, uint64_t begin, uint64_t size) {
  Blob blob;
  blob.file_ = file;
  blob.begin_ = begin;
  blob.size_ = size;
  return blob;
}

Blob Blob::in_own_file(File file) {
  Blob blob;
  blob.own_file_ = std::make_unique<File>(std::move(file));
  blob.file_ = blob.own_file_.get();
  blob.size_ = blob.file_->size();
  return blob;
}

Blob Blob::in_memory(std::vector<std::byte> bytes, MemoryBudget::Reservation memory) {
  Blob blob;
  blob.bytes_ = std::move(bytes);
  blob.memory_ = std::move(memory);
  blob.size_ = blob.bytes_.size();
  return blob;
}

void Blob::read_at(uint64_t offset, std::span<std::byte> out) const {
  SVDAG_ASSERT(offset <= size_ && out.size() <= size_ - offset);
  if (file_ != nullptr) return file_->read_at(begin_ + offset, out);
  std::copy_n(bytes_.begin() + ptrdiff_t(offset), out.size(), out.begin());
}

uint64_t ElementArray::element_bytes() const {
  return component_bytes(type) * components;
}

Blob GltfBuffers::open(uint64_t index) {
  const std::string& path = document_.file->path();
  const JsonObject buffer = document_.element("buffers", index);
  if (!buffer.has("uri")) {
    if (index == 0 && document_.bin) {
      return Blob::in_file(document_.file, *document_.bin, document_.bin_size);
    }
    fail_input(path, "needs buffers[" + std::to_string(index) + "], which has no data");
  }
  const std::string& uri = buffer.text("uri");
  if (!is_data_uri(uri)) return Blob::in_own_file(open_beside(path, uri, "buffer"));
  auto memory = budget_->reserve(uri.size(), "embedded glTF buffers");
  return Blob::in_memory(decode_data_uri(uri, path), std::move(memory));
}

std::vector<File> GltfBuffers::files() const {
  std::vector<File> files;
  const std::string& path = document_.file->path();
  for (uint64_t i = 0; i < document_.root().array("buffers").size(); ++i) {
    const std::string& uri = document_.element("buffers", i).text("uri");
    if (uri.empty() || is_data_uri(uri)) continue;
    try {
      files.push_back(open_beside(path, uri, "buffer"));
    } catch (const Error&) {  // reported when the buffer is needed
    }
  }
  return files;
}

const Blob& GltfBuffers::blob(uint64_t index) {
  const auto known = blobs_.find(index);
  if (known != blobs_.end()) return known->second;
  const uint64_t length = document_.element("buffers", index).whole_number("byteLength");
  Blob blob = open(index);
  if (length > blob.size()) {
    fail_input(document_.file->path(), "has buffers[" + std::to_string(index) + "] of " +
                                           std::to_string(length) + " bytes, but only " +
                                           std::to_string(blob.size()) + " are there");
  }
  return blobs_.emplace(index, std::move(blob)).first->second;
}

GltfBuffers::View GltfBuffers::unpacked_view(uint64_t index, const JsonObject& meshopt) {
  const MeshoptView shape = {meshopt.text("mode"), meshopt.text("filter"),
                             meshopt.whole_number("count"), meshopt.whole_number("byteStride")};
  auto known = unpacked_.find(index);
  if (known == unpacked_.end()) {
    MemoryBudget::Reservation memory;
    const auto bytes = bytes_of(view_of(meshopt, index), &memory);
    if (!unpacked_file_) unpacked_file_ = create_unpacked(document_.file->path(), spill_);
    const uint64_t begin = unpacked_bytes_;
    decode_meshopt({bytes, document_.file->path(), sandbox_}, shape, *budget_,
                   [this](std::span<const std::byte> block) {
                     unpacked_file_->write_at(unpacked_bytes_, block);
                     unpacked_bytes_ += block.size();
                   });
    known = unpacked_.emplace(index, Blob::in_file(&*unpacked_file_, begin, shape.bytes())).first;
  }
  return {&known->second, 0, known->second.size(), shape.stride};
}

GltfBuffers::View GltfBuffers::view(uint64_t index) {
  const JsonObject object = document_.element("bufferViews", index);
  std::optional<JsonObject> meshopt;
  for (const char* name : kMeshoptExtensions) {
    if (!meshopt) meshopt = object.extension(name);
  }
  // Without the library, a file may have uncompressed data as well.
  return meshopt && has_meshopt() ? unpacked_view(index, *meshopt) : view_of(object, index);
}

GltfBuffers::View GltfBuffers::view_of(const JsonObject& object, uint64_t index) {
  const Blob& data = blob(object.whole_number("buffer"));
  const View view{&data, object.whole_number("byteOffset", 0), object.whole_number("byteLength"),
                  object.whole_number("byteStride", 0)};
  if (view.begin > data.size() || view.size > data.size() - view.begin) {
    fail_input(object.path(), "has bufferViews[" + std::to_string(index) + "] outside its buffer");
  }
  return view;
}

void GltfBuffers::place(ElementArray* array, uint64_t view_index, uint64_t offset) {
  const View data = view(view_index);
  const uint64_t element = array->element_bytes();
  array->blob = data.blob;
  array->stride = data.stride == 0 ? element : data.stride;
  // begin cannot wrap once offset <= size is known; the last element must end inside the view.
  const bool fits =
      array->stride >= element && array->stride <= 65536 && offset <= data.size &&
      (array->count == 0 || (element <= data.size - offset &&
                             array->count - 1 <= (data.size - offset - element) / array->stride));
  if (!fits) {
    fail_input(document_.file->path(), "has an accessor of " + std::to_string(array->count) +
                                           " elements that does not fit bufferViews[" +
                                           std::to_string(view_index) + "]");
  }
  array->begin = data.begin + offset;
}

Accessor GltfBuffers::accessor(uint64_t index, const std::string& type) {
  const JsonObject object = document_.element("accessors", index);
  const std::string& own_type = object.text("type");
  if (type != kAnyType && own_type != type) {
    fail_input(object.path(),
               "has accessors[" + std::to_string(index) + "], which must be of type " + type);
  }
  Accessor accessor;
  accessor.path = &document_.file->path();
  accessor.base.count = object.whole_number("count");
  accessor.base.type = component_type(object);
  accessor.base.components = component_count(own_type);
  if (accessor.base.components == 0)
    fail_input(object.path(), "has accessors[" + std::to_string(index) + "] of an unknown type");
  accessor.base.normalized = object.flag("normalized");
  if (object.has("bufferView")) {
    place(&accessor.base, object.whole_number("bufferView"), object.whole_number("byteOffset", 0));
  } else if (accessor.base.count > kMaxImplicit) {
    fail_input(object.path(), "has accessors[" + std::to_string(index) + "] of " +
                                  std::to_string(accessor.base.count) + " elements without data");
  }
  if (!object.has("sparse")) return accessor;
  const JsonObject sparse = object.object("sparse");
  const JsonObject indices = sparse.object("indices");
  const JsonObject values = sparse.object("values");
  accessor.sparse_values = accessor.base;
  accessor.sparse_values.count = sparse.whole_number("count");
  place(&accessor.sparse_values, values.whole_number("bufferView"),
        values.whole_number("byteOffset", 0));
  accessor.sparse_indices.emplace();
  accessor.sparse_indices->count = sparse.whole_number("count");
  accessor.sparse_indices->type = component_type(indices);
  place(&*accessor.sparse_indices, indices.whole_number("bufferView"),
        indices.whole_number("byteOffset", 0));
  return accessor;
}

std::vector<std::byte> GltfBuffers::view_bytes(uint64_t index, MemoryBudget::Reservation* memory) {
  return bytes_of(view(index), memory);
}

std::vector<std::byte> GltfBuffers::bytes_of(const View& view, MemoryBudget::Reservation* memory) {
  *memory = budget_->reserve(view.size, "parts of glTF files");
  std::vector<std::byte> bytes(size_t(view.size));
  view.blob->read_at(view.begin, bytes);
  return bytes;
}

}  // namespace svdag
