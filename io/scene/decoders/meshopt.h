// Decodes buffer views of EXT_meshopt_compression and KHR_meshopt_compression; only meshopt.cpp
// uses the meshoptimizer library.
//
// Memory: a decoder needs a whole view at once. The codecs store at least a byte per 1024 bytes of
// vertices and per triangle, so sizes beyond kMaxRatio times the data are an Error.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

#include "streaming/memory/memory_budget.h"
#include "streaming/process/limited_child.h"

namespace svdag {

struct MeshoptView {
  std::string mode;     // ATTRIBUTES, TRIANGLES or INDICES
  std::string filter;   // NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL; empty: NONE
  uint64_t count = 0;   // of elements
  uint64_t stride = 0;  // bytes of an element

  uint64_t bytes() const { return count * stride; }
};

struct MeshoptSource {
  std::span<const std::byte> bytes;
  std::string path;      // for errors
  bool sandbox = false;  // with a system call filter
};

bool has_meshopt();

constexpr const char* kMeshoptExtensions[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
inline bool is_meshopt_extension(std::string_view name) {
  return std::ranges::find(kMeshoptExtensions, name) != std::end(kMeshoptExtensions);
}

// Passes the decoded bytes to `out`, in blocks: view.bytes() in total. Decodes in a limited child
// process. A view that the extension does not allow, or broken data, is an Error (kBadInput).
void decode_meshopt(const MeshoptSource& source, const MeshoptView& view,
                    const MemoryBudget& budget, const BlockSink& out);

}  // namespace svdag
