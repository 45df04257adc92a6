// Decodes Draco meshes; only draco.cpp uses Google's Draco library.
//
// Positions that Draco stores as integers q are dequantised here, in double: min + q * step with
// step = range / (2^bits - 1); Draco itself would round to float at each operation.
//
// Memory: an entropy-coded mesh may take less than a bit per triangle, so the counts in its header
// cannot be checked against its bytes. The bound is kMaxFree + kMaxPerByte * bytes triangles,
// points and attribute bytes (a real mesh has below 16 triangles per byte); memory for counts
// within the bound is reserved in the budget before Draco allocates it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/triangle.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

struct DracoMesh {
  std::vector<Point> positions;
  std::vector<uint32_t> indices;  // three per triangle, all below positions.size()
  double step = 0;                // distance of the quantised positions, 0 if they are not
  MemoryBudget::Reservation memory;
};

struct DracoSource {
  std::span<const std::byte> bytes;
  std::string path;                          // for errors
  std::optional<uint64_t> position_id = {};  // unique id of the attribute; else the POSITION
  bool normalized = false;                   // integers that are not quantised: c / max
  bool sandbox = false;                      // decode in a limited child process
};

bool has_draco();
// Broken data, a point cloud, or a mesh without 3D positions is an Error (kBadInput).
DracoMesh decode_draco(const DracoSource& source, MemoryBudget* budget);

}  // namespace svdag
