// A cache of small indexed primitives that several nodes draw: decoded once.
//
// A scene of plants draws a few hundred meshes thousands of times; reading and decoding one costs
// more than its triangles. A primitive is cached at its second use, if it is small and the cache
// stays within a 64th of the memory budget, and 16 MiB. Rejected: caching at the first use
// (terrain, drawn once, would fill the cache).
#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <vector>

#include "io/scene/gltf/gltf_buffers.h"
#include "io/triangle.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

struct KeptPrimitive {
  std::vector<Point> points;  // as stored, before any transform
  std::vector<uint32_t> indices;
};

class KeptPrimitives {
 public:
  explicit KeptPrimitives(MemoryBudget* budget)
      : room_(std::min<uint64_t>(uint64_t(16) << 20, budget->limit() / 64)),
        memory_(budget->reserve(0, kPurpose)) {}

  // The primitive that this JSON value describes, or null if it is not cached.
  const KeptPrimitive* find(const nlohmann::json& primitive) const {
    const auto found = met_.find(&primitive);
    return found == met_.end() || found->second.indices.empty() ? nullptr : &found->second;
  }
  // Called at every reference to a primitive: caches it now, or returns null.
  const KeptPrimitive* meet(const nlohmann::json& primitive, const Accessor& positions,
                            const Accessor& indices);

 private:
  static constexpr const char* kPurpose = "repeated glTF meshes";
  static constexpr uint64_t kMaxBytes = uint64_t(1) << 20;  // of one primitive

  uint64_t room_;
  MemoryBudget::Reservation memory_;
  std::unordered_map<const nlohmann::json*, KeptPrimitive> met_;
};

}  // namespace svdag
