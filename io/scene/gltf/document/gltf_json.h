// Parses the JSON text of a glTF file into a tree of values, without members that are not read
// (images and animations, unless they are requested).
//
// The text is read through a window; the memory of the values is reserved in the budget. The tree
// is built from the parser's events. Rejected: the parser's own callback filter, which searches
// every array again for values to discard after each object in it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

// Parts of a document that are read only on request.
struct GltfParts {
  bool images = false;  // textures, images and samplers
  bool animations = false;
  bool all = false;  // every member: of other JSON than a glTF document
};

// Bytes [begin, end) of `file`. What is not JSON or nests deeper than 256 levels is an Error
// (kBadInput). `memory` grows with the values. `parts`: what is read, too.
nlohmann::json parse_gltf_json(const File& file, uint64_t begin, uint64_t end, GltfParts parts,
                               MemoryBudget::Reservation* memory);

}  // namespace svdag
