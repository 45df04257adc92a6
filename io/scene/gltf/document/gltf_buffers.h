// Buffers, buffer views and accessors of a glTF file.
//
// Notation: a Blob is one buffer: a part of a file (GLB chunk or .bin) or decoded base64. An
// accessor is `count` elements of 1 to 4 components in a buffer view; a sparse accessor has
// replacements for some elements. Elements are streamed through a small window, never held.
// min and max of accessors are not read: they are often wrong.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/scene/gltf/document/gltf_document.h"
#include "io/scene/mesh/mesh_reader.h"
#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

// The bytes of one buffer.
class Blob {
 public:
  static Blob in_file(const File* file, uint64_t begin, uint64_t size);
  static Blob in_own_file(File file);
  static Blob in_memory(std::vector<std::byte> bytes, MemoryBudget::Reservation memory);

  uint64_t size() const { return size_; }
  // Fills `out` from byte `offset`; the range must lie inside.
  void read_at(uint64_t offset, std::span<std::byte> out) const;

 private:
  const File* file_ = nullptr;  // the scene file; else own_file_, else bytes_
  std::unique_ptr<File> own_file_;
  std::vector<std::byte> bytes_;
  MemoryBudget::Reservation memory_;
  uint64_t begin_ = 0;
  uint64_t size_ = 0;
};

enum class ComponentType : uint32_t {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
  kDouble = 5130  // of decoded data only: glTF does not have it
};

// Elements at begin, begin + stride, ... of `blob`, or zeros without a blob.
struct ElementArray {
  const Blob* blob = nullptr;
  uint64_t begin = 0;
  uint64_t stride = 0;
  uint64_t count = 0;
  ComponentType type = ComponentType::kFloat;
  uint32_t components = 1;
  bool normalized = false;

  uint64_t element_bytes() const;
};

struct Accessor {
  ElementArray base;
  // Sparse: replacement i is for element indices[i], strictly increasing.
  std::optional<ElementArray> sparse_indices;
  ElementArray sparse_values;
  const std::string* path = nullptr;

  uint64_t count() const { return base.count; }
};

class GltfBuffers {
 public:
  // Max number of elements that the file does not store (no buffer view: zeros); otherwise 125
  // bytes of JSON could request 18 EB.
  static constexpr uint64_t kMaxImplicit = uint64_t(1) << 20;

  // Compressed views are unpacked into an anonymous file of `spill`.
  GltfBuffers(const GltfDocument& document, MemoryBudget* budget, const SpillSpace* spill = nullptr,
              bool sandbox = false)
      : document_(document), budget_(budget), spill_(spill), sandbox_(sandbox) {}

  static constexpr const char* kAnyType = "";

  // Accessor `index`, which must be of `type` ("SCALAR", "VEC3", "VEC4"; kAnyType: any) and
  // inside its buffer.
  Accessor accessor(uint64_t index, const std::string& type);
  // The files that the buffers are in, beside the scene's own; none for one that cannot be opened.
  std::vector<File> files() const;
  // All bytes of a buffer view, for a decoder that needs them in one piece.
  std::vector<std::byte> view_bytes(uint64_t index, MemoryBudget::Reservation* memory);

 private:
  struct View {
    const Blob* blob;
    uint64_t begin;
    uint64_t size;
    uint64_t stride;  // 0: elements are contiguous
  };
  View view(uint64_t index);
  // The place that `object`, buffer view `index` or its extension, describes.
  View view_of(const JsonObject& object, uint64_t index);
  // The view of `meshopt`, the EXT_meshopt_compression of buffer view `index`, unpacked.
  View unpacked_view(uint64_t index, const JsonObject& meshopt);
  std::vector<std::byte> bytes_of(const View& view, MemoryBudget::Reservation* memory);
  const Blob& blob(uint64_t index);
  Blob open(uint64_t index);
  // Places `array` (type and count are set) at `offset` of buffer view `view`.
  void place(ElementArray* array, uint64_t view, uint64_t offset);

  const GltfDocument& document_;
  MemoryBudget* budget_;
  std::map<uint64_t, Blob> blobs_;  // opened on first use: skipped nodes cost nothing
  const SpillSpace* spill_;
  bool sandbox_;
  std::optional<File> unpacked_file_;  // all unpacked views, one after the other
  uint64_t unpacked_bytes_ = 0;
  std::map<uint64_t, Blob> unpacked_;  // by view
};

}  // namespace svdag
