// Limits of a third-party decoder in a process of its own (streaming/process/limited_child.h).
#pragma once

#include <algorithm>
#include <cstring>
#include <span>

#include "io/scene/mesh/mesh_reader.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/process/limited_child.h"

namespace svdag {

// For `bytes` of compressed data: as much memory as the budget has left, and a second for every
// 64 KiB (Draco decodes ten times as much in one).
inline ChildLimits decoder_limits(uint64_t bytes, const MemoryBudget& budget, bool filter) {
  constexpr uint64_t kMaxMemory = uint64_t(1) << 40;  // where the budget has no limit
  constexpr uint64_t kBesideBudget = uint64_t(64) << 20;
  const uint64_t left = budget.limit() - std::min(budget.limit(), budget.used());
  return {kBesideBudget + std::min(left, kMaxMemory), 30 + bytes / 65536, filter};
}

// Adds the triangles that a child sent as bytes, a whole number of them.
inline void add_triangles(std::span<const std::byte> bytes, BatchWriter* out) {
  for (; !bytes.empty(); bytes = bytes.subspan(sizeof(Triangle))) {
    Triangle t;
    std::memcpy(&t, bytes.data(), sizeof t);
    out->add(t.v[0], t.v[1], t.v[2]);
  }
}

}  // namespace svdag
