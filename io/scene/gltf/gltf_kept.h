// Small indexed primitives that are drawn again: decoded once, kept for the next nodes.
//
// A scene of plants draws few hundred meshes thousands of times; reading and decoding one costs
// more than its triangles. A primitive is kept when it is met for the second time, while it is
// small and all that is kept stays within a 64th of the memory budget, and 16 MiB. Rejected:
// keeping at the first meeting (terrain, drawn once, fills the room).
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

  // The primitive that this JSON value describes, or null where it is not kept.
  const KeptPrimitive* find(const nlohmann::json& primitive) const {
    const auto found = met_.find(&primitive);
    return found == met_.end() || found->second.indices.empty() ? nullptr : &found->second;
  }
  // Called at every reference to a primitive: keeps it now, or returns null.
  const KeptPrimitive* meet(const nlohmann::json& primitive, const Accessor& positions,
                            const Accessor& indices);

 private:
  static constexpr const char* kPurpose = "repeated glTF meshes";
  static constexpr uint64_t kMostBytes = uint64_t(1) << 20;  // of one primitive

  uint64_t room_;
  MemoryBudget::Reservation memory_;
  std::unordered_map<const nlohmann::json*, KeptPrimitive> met_;
};

}  // namespace svdag
