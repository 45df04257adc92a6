#include "verify/judge/judge_vdb.h"

#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include "io/openvdb_grids.h"

namespace svdag {
namespace {

// The mesh in the form that OpenVDB requires: in doubles, in index space.
struct Adapter {
  std::span<const Triangle> triangles;

  size_t polygonCount() const { return triangles.size(); }
  size_t pointCount() const { return 3 * triangles.size(); }
  size_t vertexCount(size_t) const { return 3; }
  void getIndexSpacePoint(size_t polygon, size_t corner, openvdb::Vec3d& out) const {
    const Point& p = triangles[polygon].v[corner];
    out = openvdb::Vec3d(p.x, p.y, p.z);
  }
};

}  // namespace

void vdb_distances(std::span<const Triangle> triangles, size_t threads, const DistanceSink& sink) {
  openvdb::initialize();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  // A band of one voxel holds all requested distances, and no propagation is needed.
  const openvdb::FloatGrid::Ptr grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
      Adapter{triangles}, *transform, 1.0F, 1.0F, openvdb::tools::UNSIGNED_DISTANCE_FIELD);
  std::array<float, 512> distances;
  for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
    for (openvdb::Index i = 0; i < 512; ++i)
      distances[i] = leaf->isValueOn(i) ? leaf->getValue(i) : kFar;
    const openvdb::Coord& origin = leaf->origin();
    sink(LatticePoint(origin.x(), origin.y(), origin.z()), distances);
  }
}

}  // namespace svdag
