#include "io/scene/gltf/gltf_kept.h"

#include <span>

#include "io/scene/gltf/gltf_elements.h"

namespace svdag {

const KeptPrimitive* KeptPrimitives::meet(const nlohmann::json& primitive,
                                          const Accessor& positions, const Accessor& indices) {
  // Both counts first: they are of the file, their bytes could overflow.
  if (positions.count() > kMaxBytes || indices.count() > kMaxBytes) return nullptr;
  const uint64_t bytes = positions.count() * sizeof(Point) + indices.count() * sizeof(uint32_t);
  if (bytes > kMaxBytes || memory_.bytes() + bytes > room_) return nullptr;
  const auto [found, first] = met_.try_emplace(&primitive);
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
