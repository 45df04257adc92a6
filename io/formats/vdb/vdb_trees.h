// What vdb_read.cpp, vdb_write.cpp and nvdb.cpp share: OpenVDB's types and their transforms as
// ours.
#pragma once

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include "io/formats/vdb.h"

namespace svdag {

// What a linear transform says, to the last bit. Its affine map would not: OpenVDB inverts the
// matrix of each, which it refuses to do for voxels below 1.45e-5.
inline IndexToWorld centres_of(const openvdb::math::Transform& transform) {
  const auto point = [](const openvdb::Vec3d& p) { return Point(p.x(), p.y(), p.z()); };
  IndexToWorld centres;
  centres.origin = point(transform.baseMap()->applyMap(openvdb::Vec3d(0)));
  for (int a = 0; a < 3; ++a) {
    openvdb::Vec3d step(0);
    step[a] = 1;
    centres.axes[size_t(a)] = point(transform.baseMap()->applyJacobian(step));
  }
  return centres;
}

// A .nvdb of one grid, whose voxels are cubes along the axes, into a file that `path` opens.
void write_nano(const openvdb::MaskGrid& grid, const std::string& path);

}  // namespace svdag
