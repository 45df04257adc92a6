// Replaces embree.cpp in builds without Embree.
#ifndef SVDAG_HAS_EMBREE

#include "streaming/error.h"
#include "verify/trace/judge/embree.h"

namespace svdag {

struct TriangleTracer::Scene {};

TriangleTracer::TriangleTracer(const Vec3& middle, uint64_t, size_t, MemoryBudget*)
    : middle_(middle) {
  fail_usage(
      "this svdag-verify was built without Embree: build it with -DSVDAG_EMBREE=ON, or use "
      "svdag-verify mesh");
}
TriangleTracer::~TriangleTracer() = default;
void TriangleTracer::add(std::span<const LatticeTriangle>, int) {}
void TriangleTracer::build() {}
bool TriangleTracer::is_opaque(uint32_t, const Vec3&) const {
  return true;
}
std::optional<TriangleHit> TriangleTracer::closest(const Ray&, double, double) const {
  return {};
}
double TriangleTracer::distance_to(const Vec3&, double within) const {
  return within;
}

}  // namespace svdag

#endif
