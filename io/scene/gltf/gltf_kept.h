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
#include <span>
#include <unordered_map>
#include <vector>

#include "io/scene/gltf/document/gltf_elements.h"
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
    const auto found = seen_.find(&primitive);
    return found == seen_.end() || found->second.indices.empty() ? nullptr : &found->second;
  }
  // Called at every reference to a primitive: caches it now, or returns null.
  const KeptPrimitive* keep_repeated(const nlohmann::json& primitive, const Accessor& positions,
                                     const Accessor& indices);

 private:
  static constexpr const char* kPurpose = "repeated glTF meshes";
  static constexpr uint64_t kMaxBytes = uint64_t(1) << 20;  // of one primitive

  uint64_t room_;
  MemoryBudget::Reservation memory_;
  std::unordered_map<const nlohmann::json*, KeptPrimitive> seen_;
};

inline const KeptPrimitive* KeptPrimitives::keep_repeated(const nlohmann::json& primitive,
                                                          const Accessor& positions,
                                                          const Accessor& indices) {
  // Both counts first: they are of the file, their bytes could overflow.
  if (positions.count() > kMaxBytes || indices.count() > kMaxBytes) return nullptr;
  const uint64_t bytes = positions.count() * sizeof(Point) + indices.count() * sizeof(uint32_t);
  if (bytes > kMaxBytes || memory_.bytes() + bytes > room_) return nullptr;
  const auto [found, first] = seen_.try_emplace(&primitive);
  if (first || indices.count() == 0) return nullptr;
  memory_.resize(memory_.bytes() + bytes, kPurpose);
  KeptPrimitive& kept = found->second;
  kept.points.resize(size_t(positions.count()));
  ElementStream(positions).read(as_numbers(kept.points));
  kept.indices.resize(size_t(indices.count()));
  ElementStream(indices).read(std::span<uint32_t>(kept.indices));
  return &kept;
}

}  // namespace svdag
