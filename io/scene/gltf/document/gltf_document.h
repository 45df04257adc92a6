// The JSON of a glTF file: found in .gltf text or the first chunk of a GLB, parsed in bounded
// space.
//
// Notation: a document is the parsed JSON without members that do not concern geometry
// (io/scene/gltf/document/gltf_json.h); BIN is the GLB's second chunk.
// Rejected: tinygltf and cgltf, which hold every buffer in memory (33 million triangles per second
// and 37 bytes per triangle against 110+ and 19 here).
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/scene/gltf/document/gltf_json.h"
#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

// A JSON object of a file; typed access; a wrong type is an Error (kBadInput).
class JsonObject {
 public:
  JsonObject(const nlohmann::json& value, const std::string& path);

  bool has(const char* key) const { return find(key) != nullptr; }
  std::vector<std::string> names() const;  // of all members, in alphabetical order
  // A whole number; without it `fallback`, and without that an Error.
  uint64_t whole_number(const char* key, std::optional<uint64_t> fallback = {}) const;
  bool flag(const char* key) const;                // false if absent
  const std::string& text(const char* key) const;  // "" if absent
  JsonObject object(const char* key) const;        // an Error if absent
  // The object extensions.<name>, if there is one.
  std::optional<JsonObject> extension(const char* name) const;
  std::span<const nlohmann::json> array(const char* key) const;  // empty if absent
  double number(const char* key, double fallback) const;
  // Fills `out` with exactly out.size() numbers; false if absent.
  bool numbers(const char* key, std::span<double> out) const;
  // A whole number that is an element of an array.
  uint64_t index(const nlohmann::json& element, const char* key) const;

  const std::string& path() const { return *path_; }

 private:
  const nlohmann::json* find(const char* key) const;
  [[noreturn]] void fail(const char* key, const char* expected) const;

  const nlohmann::json* value_;
  const std::string* path_;
};

struct GltfDocument {
  const File* file = nullptr;
  nlohmann::json json;
  std::optional<uint64_t> bin;  // where the BIN chunk's bytes begin
  uint64_t bin_size = 0;
  MemoryBudget::Reservation memory;

  JsonObject root() const { return JsonObject(json, file->path()); }
  // Element `index` of the top-level array `key`.
  JsonObject element(const char* key, uint64_t index) const;
};

// Where the glTF is in its file.
struct GltfBytes {
  uint64_t begin = 0, end = UINT64_MAX;
};

// `file` must outlive the document. A file that is not glTF 2.x, is truncated, nests deeper than
// 256 levels, or requires an extension that would change the geometry is an Error (kBadInput).
// `parts`: what the document has, too.
GltfDocument load_gltf(const File& file, MemoryBudget* budget, GltfParts parts = {},
                       GltfBytes bytes = {});

}  // namespace svdag
