// Decodes Draco meshes in a limited child; only draco.cpp uses Google's Draco library.
//
// Positions that Draco stores as integers q are dequantised here, in double: min + q * step with
// step = range / (2^bits - 1); Draco itself would round to float at each operation.
//
// Memory: an entropy-coded mesh may take less than a bit per triangle, so the counts in its header
// cannot be checked against its bytes. max_draco_elements() is a bound (a real mesh has below 16
// triangles per byte); the child gets the memory that so many need, or that the budget has left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/triangle.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

struct DracoAttribute {
  uint64_t id = 0;  // unique
  uint64_t components = 0;
};

struct DracoSource {
  std::span<const std::byte> bytes;
  std::optional<uint64_t> position_id = {};  // unique id of the attribute; else the POSITION
  bool normalized = false;                   // integers that are not quantised: c / max
  // Beside the positions; integers are normalised. With any, a vertex is a point of the mesh, a
  // combination of values, and not a position.
  std::vector<DracoAttribute> attributes = {};
};

// Receives the meshes one after the other: of each first all positions, then the other attributes,
// one after the other, then all triangles. The first of several may begin twice.
struct DracoReceiver {
  // `source`: the number of the mesh. `step`: distance of the quantised positions, 0 if they are
  // not.
  std::function<void(size_t source, double step)> begin;
  std::function<void(std::span<const Point>)> positions;
  std::function<void(std::span<const uint32_t>)> indices;        // may be out of range
  std::function<void(std::span<const double>)> attributes = {};  // pieces of their values
};

bool has_draco();

// Max number of triangles and of points in so many bytes.
constexpr uint64_t max_draco_elements(uint64_t bytes) {
  return (uint64_t(1) << 18) + 1024 * bytes;
}

// Decodes the sources in order and returns how many were decoded, at least one. It may stop before
// a source that cannot be decoded, which then is an Error where it comes first: broken data, a
// point cloud, or a mesh without 3D positions or an attribute (kBadInput), or too little memory
// (kMemory). `path`: of the scene, for errors.
size_t decode_draco(std::span<const DracoSource> sources, const std::string& path,
                    const MemoryBudget& budget, bool sandbox, const DracoReceiver& receiver);

}  // namespace svdag
