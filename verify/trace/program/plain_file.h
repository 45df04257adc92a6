// A .svdag file in memory, read without any third-party library, for svdag-trace.
//
// Sizes and all pointers are validated in one pass over the sections (docs/format.md), so a tracer
// may trust the view. Checksums are ignored, because they need xxHash; svdag-verify check tests
// them. A file that is written while it is read is therefore detected by its time of modification.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/dag/layers/layer_index.h"
#include "io/dag/layers/layer_table.h"

namespace svdag {

struct PlainFile {
  std::vector<uint64_t> words;      // the bytes of the file, aligned, and room for a root
  DagView view;                     // of what is traced: the first root, or a layer
  LayerTable layers;                // empty in a file without
  std::optional<LayerIndex> index;  // of a file with layers: of those that are traced

  const Header& header() const { return *reinterpret_cast<const Header*>(words.data()); }
  uint64_t bytes() const { return header().file_bytes; }
};

// Error: kBadInput if the file cannot be read, is damaged, or is written while it is read; kMemory
// if it is larger than `max_bytes`.
PlainFile read_plain_file(const std::string& path, uint64_t max_bytes = UINT64_MAX);

// Sets `view` and `index` to layer `layer` of the table. The view stays within `words`.
void show_layer(PlainFile* file, size_t layer);

}  // namespace svdag
