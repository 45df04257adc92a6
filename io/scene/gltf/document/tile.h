// The glTF content of a scene file and where it is placed: a glTF file itself, placed once; or a
// tile of 3D Tiles 1.0, a batched (.b3dm) or an instanced (.i3dm) model.
//
// A tile is z-up: its y-up glTF is turned, then placed by the instances (right, up, scale,
// position) and RTC_CENTER. Instances are read one by one from the binary feature table. Not read:
// batch tables, which hold no geometry. Rejected by an Error: EAST_NORTH_UP, whose axes depend on
// an ellipsoid.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "io/affine.h"
#include "io/scene/gltf/document/gltf_document.h"
#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

bool begins_as_batched_tile(std::string_view start);
bool begins_as_instanced_tile(std::string_view start);

class Tile {
 public:
  // `file` must outlive the tile.
  Tile(const File& file, MemoryBudget* budget);
  Tile(const Tile&) = delete;

  const File& gltf_file() const { return beside_ ? *beside_ : file_; }
  GltfBytes gltf_bytes() const { return bytes_; }  // of gltf_file()
  // The file that the tile names instead of an embedded glTF, or null.
  const File* beside() const { return beside_ ? &*beside_ : nullptr; }

  uint64_t instances() const { return instances_; }
  Affine placement(uint64_t instance) const;

 private:
  void read_instanced();
  void read_features(uint64_t begin);
  JsonObject features() const { return JsonObject(features_, file_.path()); }
  // Where the property `key` begins, of so many bytes per instance.
  uint64_t binary_offset(const char* key, uint64_t bytes) const;
  // Numbers of a property that is one per instance.
  template <class Component>
  std::array<double, 3> values(const char* key, uint64_t instance, int components) const;
  // Three numbers of a property of the whole tile, which are in the JSON or in the binary table.
  bool global(const char* key, std::array<double, 3>* out) const;
  std::array<double, 3> direction(const char* key, const char* octahedral, uint64_t instance) const;

  const File& file_;
  std::optional<File> beside_;
  GltfBytes bytes_;
  bool is_tile_ = false;
  bool is_instanced_ = false;
  uint64_t instances_ = 1;
  nlohmann::json features_;
  uint64_t binary_begin_ = 0, binary_bytes_ = 0;
  MemoryBudget::Reservation memory_;
  std::array<double, 3> centre_{0, 0, 0};
};

}  // namespace svdag
